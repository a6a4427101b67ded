"""Whether a device can be used, asked before minutes are spent on what leads up to it."""

from __future__ import annotations

from kfmaps._arrays import MissingDependency, refuse


def check_device(device: str) -> str:
    """Return ``device`` when arrays can be made on it.

    Raises
    ------
    MissingDependency
        When it needs PyTorch, which is not installed.
    InvalidInput
        When PyTorch does not have it.
    """
    if device == "cpu":
        return device
    try:
        import torch
    except ImportError as error:
        remedy = "install it with: pip install 'kfmaps[gpu]'"
        raise MissingDependency(f"--device {device}: wanted PyTorch, got none; {remedy}") from error
    try:
        torch.empty(1, dtype=torch.float64, device="cpu" if device == "torch" else device)
    except Exception as error:  # PyTorch reports what is not there by whatever it runs into
        got = str(error).partition("\n")[0][:120] or type(error).__name__
        raise refuse(f"--device {device}", "a device that PyTorch can use", got, "use cpu") from error
    return device
