"""Every setting there is, said once: for the command's options, for settings files and for docs/settings.md."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Setting:
    """One number or choice of a configuration.

    Attributes
    ----------
    path : str
        Where it stands in :func:`kfmaps.config.as_dict`, with dots. ``NAME.kind`` chooses among records.
    type : type
        What an option takes: int, float, str or bool.
    meaning : str
    values : str
        Its range, or the choices.
    flag : str
        The option that sets it; empty when only ``--set`` and settings files do.
    kinds : tuple of str
        The records that have it, where there are several.
    """

    path: str
    type: type
    meaning: str
    values: str
    flag: str = ""
    kinds: tuple[str, ...] = ()

    @property
    def section(self) -> str:
        """The first part of the path, or "" at the top."""
        return self.path.rpartition(".")[0]

    @property
    def field(self) -> str:
        """The last part of the path."""
        return self.path.rpartition(".")[2]

    @property
    def argument(self) -> str:
        """The name that the flag has as a Python argument."""
        return self.flag.removeprefix("--").replace("-", "_")


_SHAPES = ("Gaussian", "Laplacian")

CATALOGUE: dict[str, tuple[Setting, ...]] = {
    "Basis": (
        Setting("basis.functions", int, "size of the functional map on both sides", "at least 2", "--basis"),
        Setting(
            "basis.laplacian", str, "the Laplacian; robust takes any triangles", "robust, cotangent", "--laplacian"
        ),
    ),
    "Descriptors": (
        Setting("descriptors.count", int, "spectral descriptors in all", "at least 1", "--descriptors"),
        Setting("descriptors.signature", str, "signature of each point", "wave, heat, none", "--signature"),
        Setting("descriptors.landmark_map", str, "map of each landmark", "wave, heat, none", "--landmark-map"),
        Setting("descriptors.signature_share", float, "part of the count for the signature, with landmarks", "0 to 1"),
        Setting("descriptors.eigenfunctions", int, "eigenfunctions that descriptors are made from", "at least 2"),
        Setting("descriptors.layout", str, "energies: evenly spread, or each n-th of 200", "even, every-nth"),
        Setting("descriptors.shot", bool, "add the SHOT descriptor of the local surface", "true, false", "--shot"),
        Setting("descriptors.shot_radius", float, "radius of SHOT in √area", "above 0"),
        Setting("descriptors.shot_weight", float, "weight of SHOT against 1 for all others together", "above 0"),
        Setting(
            "descriptors.normalisation",
            str,
            "how descriptors are scaled, alike on both shapes",
            "none, norm, max, row, variance",
            "--normalisation",
        ),
    ),
    "Kernel": (
        Setting(
            "kernel.kind",
            str,
            "the kernel",
            "gaussian, laplacian, linear, polynomial, tanh; sum, product, metric, network, scaled in files",
            "--kernel",
        ),
        Setting(
            "kernel.gamma",
            float,
            "the kernel's γ, per squared unit of the descriptors (laplacian: per unit)",
            "above 0, or automatic",
            "--gamma",
            _SHAPES,
        ),
        Setting("sharpness", float, "automatic γ times the typical squared distance", "above 0", "--sharpness"),
        Setting("kernel.degree", int, "degree of the polynomial kernel", "at least 1", "--degree", ("Polynomial",)),
        Setting(
            "kernel.offset",
            float,
            "what the polynomial or tanh kernel adds to x·y",
            "polynomial: at least 0; tanh: any",
            "--offset",
            ("Polynomial", "Tanh"),
        ),
        Setting("kernel.scale", float, "factor of x·y in the tanh kernel", "above 0", "--scale", ("Tanh",)),
        Setting("kernel.a", str, "first kernel of a sum or product", "a kernel", kinds=("Sum", "Product")),
        Setting("kernel.b", str, "second kernel of a sum or product", "a kernel", kinds=("Sum", "Product")),
        Setting("kernel.kernel", str, "the kernel inside", "a kernel", kinds=("Metric", "Network", "Scaled")),
        Setting("kernel.matrix", str, "weights of descriptors, or rows of a metric", "numbers", kinds=("Metric",)),
        Setting(
            "kernel.landmarks", int, "landmarks that it was learned with", "at least 0, or none: any", kinds=("Metric",)
        ),
        Setting("kernel.layers", str, "matrices of a network, biases last", "numbers", kinds=("Network",)),
        Setting("kernel.columns", str, "descriptors that a network sees", "numbers; none: all", kinds=("Network",)),
        Setting("kernel.factor", float, "factor of the kernel inside", "above 0", kinds=("Scaled",)),
        Setting("exact", bool, "the whole kernel in row blocks, no Nyström; slow", "true, false", "--exact"),
    ),
    "Nyström": (
        Setting("nystrom.samples", int, "samples of both shapes together", "at least 2", "--samples"),
        Setting(
            "nystrom.sampling",
            str,
            "how samples are chosen",
            "descriptor, geodesic, uniform, cholesky, random-cholesky, squared-cholesky",
            "--sampling",
        ),
        Setting("nystrom.rtol", float, "kernel eigenvalues below this part of the largest are dropped", "0 to below 1"),
    ),
    "Energy": (
        Setting("weights.laplacian", float, "weight of Laplacian commutativity, α", "at least 0", "--alpha"),
        Setting(
            "weights.descriptors", float, "weight of descriptor preservation", "at least 0", "--weight-descriptors"
        ),
        Setting(
            "weights.commutativity",
            float,
            "weight of commutativity with multiplication by descriptors",
            "at least 0",
            "--weight-commutativity",
        ),
        Setting(
            "weights.orientation",
            float,
            "weight of the term that tells a map from a mirrored one",
            "at least 0",
            "--weight-orientation",
        ),
        Setting("compression", float, "part of the slices' squared norm that may be left out", "0 to below 1"),
    ),
    "Formulation": (
        Setting("formulation.constraint", str, "what the map must be", "none, orthogonal", "--constraint"),
        Setting(
            "formulation.directions",
            str,
            "whether both maps are fitted, tied to each other",
            "one, both",
            "--directions",
        ),
        Setting("formulation.inverse", float, "weight of each map being the other's inverse", "at least 0"),
        Setting("formulation.adjoint", float, "weight of each map being the other's adjoint", "at least 0"),
        Setting("formulation.loss", str, "loss of the data", "squared, huber, l21, geman", "--loss"),
        Setting(
            "formulation.loss_per", str, "whose residuals the loss is of", "landmark, descriptor, feature", "--loss-per"
        ),
        Setting("formulation.loss_width", float, "scale of the loss, in medians of the residuals", "above 0"),
        Setting("formulation.sparsity", float, "weight of entries far from the diagonal", "at least 0", "--sparsity"),
        Setting("formulation.spatial", float, "weight of a map that moves all area", "at least 0", "--spatial"),
        Setting("formulation.spatial_blur", float, "softness of that map, in nearest points' costs", "above 0"),
        Setting("formulation.mask", str, "how Laplacian commutativity weighs entries", "squared, resolvent", "--mask"),
        Setting("formulation.mask_power", float, "power of the Laplacian in the resolvent", "above 0"),
        Setting("formulation.bases", str, "bases that the Laplacians meet in", "own, coupled", "--bases"),
        Setting("formulation.coupling", float, "weight of the map in the choice of coupled bases", "above 0"),
        Setting("formulation.rounds", int, "rounds of reweighting and of both directions", "at least 1"),
    ),
    "Solver": (
        Setting("solver.kind", str, "conjugate gradients, or dense for small bases", "cg, direct", "--solver"),
        Setting("solver.rtol", float, "relative residual at which CG stops", "at least 0", "--rtol", ("CG",)),
        Setting("solver.max_steps", int, "steps after which CG stops", "at least 1, or none", "--max-steps", ("CG",)),
        Setting("solver.limit", int, "most unknowns that the dense solver takes", "at least 1", kinds=("Direct",)),
        Setting("preconditioner", str, "preconditioner of CG", "sylvester, jacobi, none", "--preconditioner"),
        Setting("fit_samples", int, "points of each shape that the fit is made from", "at least 2, or none: all"),
    ),
    "Refinement": (
        Setting("refinement.kind", str, "what improves the map after the fit", "zoomout, icp, none", "--refine"),
        Setting("refinement.start", int, "first size of ZoomOut", "at least 2", "--zoom-start", ("ZoomOut",)),
        Setting("refinement.stop", int, "last size of ZoomOut", "at least the first", "--zoom-stop", ("ZoomOut",)),
        Setting("refinement.step", int, "growth per step of ZoomOut", "at least 1", "--zoom-step", ("ZoomOut",)),
        Setting(
            "refinement.samples",
            int,
            "points that all steps of ZoomOut but the last work on",
            "at least 2, or all",
            "--zoom-samples",
            ("ZoomOut",),
        ),
        Setting("refinement.seed", int, "for the choice of these points", "at least 0", kinds=("ZoomOut",)),
        Setting(
            "refinement.guidance",
            float,
            "weight of SHOT in the steps of ZoomOut after a search",
            "at least 0",
            kinds=("ZoomOut",),
        ),
        Setting("refinement.steps", int, "steps of ICP", "at least 1", "--icp-steps", ("ICP",)),
    ),
    "Finish": (
        Setting("finish.kind", str, "what makes a refined map finer than vertices", "nonrigid, none", "--finish"),
        Setting("finish.stiffness", float, "of the first level, in units of area", "above 0", kinds=("NonRigid",)),
        Setting("finish.levels", int, "each a third as stiff as the one before", "at least 1", kinds=("NonRigid",)),
        Setting("finish.steps", int, "searches for closest points at each level", "at least 1", kinds=("NonRigid",)),
        Setting("finish.evenness", float, "area over which rotations are averaged", "at least 0", kinds=("NonRigid",)),
        Setting("finish.stretch", float, "area over which sizes may change evenly", "at least 0", kinds=("NonRigid",)),
    ),
    "Search": (
        Setting("search.kind", str, "whether several maps are tried", "search, none"),
        Setting("search.candidates", int, "how many small fits are tried", "at least 1", "--candidates", ("Search",)),
        Setting(
            "search.orientation",
            str,
            "whether the map keeps orientation, is one to a mirror image, or whichever fits clearly better; auto: kept "
            "unless that would bend the source unduly",
            "auto, kept, reversed, either",
            "--orientation",
            ("Search",),
        ),
        Setting("search.runners_up", int, "distinct other maps that are kept", "at least 0", kinds=("Search",)),
        Setting("search.signs", int, "low functions whose signs are tried", "0 to 10", kinds=("Search",)),
        Setting("search.tips", bool, "pair the tips of limbs in all likely ways", "true, false", kinds=("Search",)),
    ),
    "Parts": (
        Setting(
            "partial.which",
            str,
            "which shape may be a part of the other; auto tells by boundaries and fit",
            "auto, none, source, target, both",
            "--partial",
        ),
        Setting(
            "partial.units", str, "whether sizes of the shapes can be compared as given", "unknown, same", "--units"
        ),
        Setting("partial.samples", int, "points of the part that are matched first", "at least 20"),
        Setting("partial.whole_samples", int, "points of the whole that they are matched with", "at least 20"),
        Setting("partial.candidates", int, "scales of the part that are followed up", "at least 1"),
    ),
    "Machine": (
        Setting("device", str, "cpu, or a PyTorch device", "cpu, cuda, cuda:1, ..., torch", "--device"),
        Setting("threads", int, "Python threads", "at least 1, or none: every core", "--threads"),
    ),
}
"""By the panel that the command's help shows them in."""

SETTINGS: tuple[Setting, ...] = tuple(setting for group in CATALOGUE.values() for setting in group)

FLAGS: dict[str, Setting] = {setting.flag: setting for setting in SETTINGS if setting.flag}

PRESETS: dict[str, str] = {
    "default": "recommended: a search, with landmarks or without",
    "single-fit": "one fit, without a search",
    "paper": "the paper's section 7",
    "no17": "Nogneng and Ovsjanikov 2017: no kernel",
    "obcs12": "Ovsjanikov et al. 2012: no kernel, descriptors only",
    "kovnatsky13": "coupled bases, no kernel",
    "pokrass13": "a sparse map, no kernel",
    "kovnatsky15": "a robust loss per descriptor, no kernel",
    "kovnatsky16": "the same over orthogonal maps, no kernel",
    "eynard16": "both directions, each the other's inverse, no kernel",
    "huang17": "both directions, each the other's adjoint, no kernel",
    "gasparetto17": "a map that moves the whole area of both shapes, no kernel",
    "ren19": "NO17 with the resolvent mask",
}
