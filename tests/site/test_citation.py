"""The citation file says what the package says."""

from pathlib import Path

import yaml

import world2minecraft

ROOT = Path(__file__).resolve().parents[2]


def test_the_citation_file_fits_the_program():
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert cited["version"] == world2minecraft.__version__
    assert {"cff-version", "message", "title", "authors", "license"} <= set(cited)
    assert cited["license"] == "Apache-2.0"
    (paper,) = cited["references"]
    assert paper["title"] in (ROOT / "docs" / "reference" / "licences.md").read_text()
    assert all(
        one["family-names"] in (ROOT / "docs" / "reference" / "licences.md").read_text()
        for one in paper["authors"]
    )
