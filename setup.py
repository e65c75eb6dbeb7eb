"""What pyproject.toml has no words for: cases/ is part of the package, as `dilatedem init` writes its files anywhere."""

from setuptools import find_namespace_packages, setup

setup(
    packages=[*find_namespace_packages(include=["dilatedem*"]), "dilatedem.cases"],
    package_dir={"dilatedem.cases": "cases"},
)
