# SPDX-License-Identifier: BSD-3-Clause
"""The package mps; bindings/python/wheel calls this with the libraries in mps/lib."""
import re
from pathlib import Path

from setuptools import setup
from wheel.bdist_wheel import bdist_wheel

HERE = Path(__file__).resolve().parent


class Wheel(bdist_wheel):
    """One wheel for every Python 3 of this platform: the libraries are plain C."""

    def finalize_options(self) -> None:
        super().finalize_options()
        self.root_is_pure = not (HERE / "mps/lib").exists()

    def get_tag(self) -> tuple[str, str, str]:
        _, _, platform = super().get_tag()
        return "py3", "none", platform


setup(
    name="mps",
    version=re.search(r'MPS_VERSION_STRING = "?\'?([\d.]+)', (HERE / "mps/_numbers.py").read_text())[1],
    description="Moving particle semi-implicit method for violent sloshing",
    long_description="Python bindings of libmps: simulations, models written in Python, case files, coupling.",
    license="BSD-3-Clause",
    packages=["mps"],
    package_data={"mps": ["py.typed", "lib/*", "lib/copyright/*"]},
    python_requires=">=3.9",
    install_requires=["numpy>=1.19"],
    cmdclass={"bdist_wheel": Wheel},
)
