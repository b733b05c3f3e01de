"""Puts the specifications of sweeps/ into the package that is built; all else stands in pyproject.toml."""

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py


class WithExamples(build_py):
    """The package as it lies here, and its examples."""

    def run(self):
        """Build, then copy."""
        super().run()
        if not self.editable_mode:
            shutil.copytree("sweeps", Path(self.build_lib) / "freesweep" / "examples", dirs_exist_ok=True)


setup(cmdclass={"build_py": WithExamples})
