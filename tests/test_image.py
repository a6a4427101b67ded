"""The Dockerfile and the scripts of docs/cluster.md; as a program, the steps of the image without a builder.

``python tests/test_image.py [PYTHON]`` copies what the Dockerfile copies, runs its commands with an environment in the
place of /opt/kfmaps, and matches the demo's shapes from a folder that holds nothing else. It downloads packages.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
DOCKERFILE = (ROOT / "Dockerfile").read_text(encoding="utf-8")
STEPS = [tuple(line.split(maxsplit=1)) for line in DOCKERFILE.splitlines() if line and not line.startswith("#")]
MOUNTED, PREFIX = "/work", "/opt/kfmaps"


def steps(kind: str) -> list[str]:
    return [rest for name, rest in STEPS if name == kind]


def block(language: str) -> str:
    """The one block in a language of the page on clusters."""
    page = (ROOT / "docs" / "cluster.md").read_text(encoding="utf-8")
    (found,) = re.findall(rf"^```{language}\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    return found


def copied() -> list[str]:
    """What the first stage copies from the repository."""
    return [name for rest in steps("COPY") if not rest.startswith("--from") for name in rest.split()[:-1]]


def test_files_copied_into_the_image_exist_and_are_not_ignored() -> None:
    kept = {line[1:] for line in (ROOT / ".dockerignore").read_text().splitlines() if line.startswith("!")}
    assert set(copied()) == kept
    assert all((ROOT / name).exists() for name in copied())


def test_the_user_is_not_root_and_the_versions_are_pinned() -> None:
    kinds = [name for name, _ in STEPS]
    (user,) = steps("USER")
    assert user not in ("root", "0")
    assert f" {user}" in steps("RUN")[-1]
    assert kinds.index("USER") < kinds.index("ENTRYPOINT")
    assert "RUN" not in kinds[kinds.index("USER") :]
    assert "--constraint constraints.txt" in steps("RUN")[0]
    assert len({image.split()[0] for image in steps("FROM")}) == 1
    assert steps("WORKDIR")[-1] == MOUNTED


def test_the_job_of_kubernetes_runs_what_the_image_has() -> None:
    import yaml

    spec = yaml.safe_load(block("yaml"))["spec"]
    pod = spec["template"]["spec"]
    (container,) = pod["containers"]
    assert pod["securityContext"]["runAsNonRoot"]
    assert f"--uid {pod['securityContext']['runAsUser']} " in steps("RUN")[-1]
    assert container["volumeMounts"] == [{"name": pod["volumes"][0]["name"], "mountPath": MOUNTED}]
    assert container["args"][0] == "batch"
    assert container["args"][-1] == container["resources"]["requests"]["cpu"]
    assert spec["podFailurePolicy"]["rules"][0]["onExitCodes"]["values"] == [1, 2]


def test_the_script_for_slurm_runs(tmp_path: Path) -> None:
    """With an ``srun`` that starts one worker here; the command is told the address of a scheduler that answers."""
    programs = tmp_path / "bin"
    programs.mkdir()
    listening = "--host 127.0.0.1"
    program(programs / "srun", f'shift; shift; exec "$@" {listening}')
    program(programs / "dask", f'exec "{sys.executable}" -m dask "$@"')
    program(programs / "python", f'exec "{sys.executable}" "$@"')
    output = (
        "import sys; from distributed import Client; c = Client(sys.argv[1]); c.wait_for_workers(1, 60); print('well')"
    )
    program(programs / "kfmaps", f'echo "$@"; {sys.executable} -c "{output}" "${{@: -1}}"; exit 7')
    (tmp_path / "job.sh").write_text(block("bash"), encoding="utf-8")
    environment = os.environ | {"PATH": f"{programs}:{os.environ['PATH']}", "DIR": "shapes", "OUT": "out of it"}
    done = subprocess.run(
        ["bash", "job.sh"], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 7, done.stderr
    assert re.fullmatch(r"batch shapes -o out of it --graph both --workers tcp://127.0.0.1:\d+\nwell\n", done.stdout)


def program(path: Path, script: str) -> None:
    path.write_text(f"#!/bin/bash\n{script}\n", encoding="utf-8")
    path.chmod(0o755)


def main() -> None:
    python = sys.argv[1] if len(sys.argv) > 1 else sys.executable
    with tempfile.TemporaryDirectory() as folder:
        build, prefix, work = (Path(folder) / name for name in ("build", "kfmaps", "work"))
        for path in (build, work):
            path.mkdir()
        for name in copied():
            source = ROOT / name
            copy = shutil.copytree if source.is_dir() else shutil.copy
            copy(source, build / name)
        command = steps("RUN")[0].replace(PREFIX, str(prefix)).replace("python -m venv", f"{python} -m venv", 1)
        subprocess.run(command, shell=True, cwd=build, check=True)
        variables = dict(pair.split("=", 1) for rest in steps("ENV") for pair in rest.split())
        path = variables.pop("PATH").replace(PREFIX, str(prefix)).replace("$PATH", os.defpath)
        environment = variables | {"PATH": path, "HOME": "/nonexistent"}
        (entry,) = re.findall(r'"(\w+)"', steps("ENTRYPOINT")[0])
        for words in (
            ["--help"],
            ["demo", "--write", ".", "--vertices", "1500"],
            ["match", "a.ply", "b.ply", "--json"],
        ):
            subprocess.run([prefix / "bin" / entry, *words], cwd=work, env=environment, check=True)


if __name__ == "__main__":
    main()
