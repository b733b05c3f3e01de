"""What comes with the package for first steps: the specifications of ``sweeps/``, and the atlas that one of them makes."""

from pathlib import Path

from .atlas.store import Atlas, open_atlas

HERE = Path(__file__).parent
SWEEPS = HERE / "examples" / "sweeps"  # in a checkout a link to the folder of that name


def example_atlas() -> Atlas:
    """The atlas of ``freesweep sweep --example quick``, which comes along: both angles, two lengths, two radii."""
    return open_atlas(HERE / "examples" / "quick.nc")


def specifications() -> dict[str, Path]:
    """Specifications of sweeps by name."""
    return {path.stem: path for path in sorted(SWEEPS.glob("*.toml"))}


def specification(name: str) -> Path:
    """The file of one of them; raises ValueError for an unknown name."""
    import difflib

    known = specifications()
    if name not in known:
        near = difflib.get_close_matches(name, known, n=1, cutoff=0.4)
        meant = f"did you mean {near[0]!r}? " if near else ""
        raise ValueError(f"--example: found {name!r:.60}; {meant}there are {', '.join(known)}")
    return known[name]
