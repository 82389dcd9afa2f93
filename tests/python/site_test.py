"""The documentation's site builds without warnings, all its links resolve, and it loads nothing from other hosts."""

import os
import pathlib
import subprocess
import sys
from html.parser import HTMLParser
from urllib.parse import unquote, urlsplit

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]


class Page(HTMLParser):
    """Anchors, links, resources and text of a page."""

    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.resources, self.text = set(), [], [], []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.anchors.update(value for key, value in attributes.items() if key in ("id", "name") and value)
        if tag == "a" and attributes.get("href"):
            self.links.append(attributes["href"])
        if tag in ("img", "script", "iframe", "source") and attributes.get("src"):
            self.resources.append(attributes["src"])
        if tag == "link" and attributes.get("rel") != "canonical":
            self.resources.append(attributes["href"])

    def handle_data(self, text):
        self.text.append(text)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    subprocess.run([sys.executable, SOURCE / "docs/site/make.py", folder / "pages"], check=True)
    built = subprocess.run(
        ["mkdocs", "build", "--strict", "-f", SOURCE / "docs/site/mkdocs.yml", "-d", folder / "site"],
        env={**os.environ, "BOLTZMANN_PAGES": str(folder / "pages")}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert built.returncode == 0, built.stderr
    return {path: Page(path) for path in (folder / "site").rglob("*.html")}


def test_links_resolve(site):
    wrong = []
    for path, page in site.items():
        for link in page.links + page.resources:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc or path.name == "404.html":
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            target = target / "index.html" if target.is_dir() else target
            if not target.exists():
                wrong.append(f"{path.name}: {link}")
            elif parts.fragment and target in site and unquote(parts.fragment) not in site[target].anchors:
                wrong.append(f"{path.name}: {link}: no such anchor")
    assert not wrong, "\n".join(wrong)


def test_nothing_is_loaded_from_other_hosts(site):
    asked = {link for page in site.values() for link in page.resources if urlsplit(link).scheme not in ("", "data") or urlsplit(link).netloc}
    assert not asked
    (style,) = {path.parent for path in site if path.parent.name == "tutorials"}
    for sheet in (style.parent / "assets").rglob("*.css"):
        text = sheet.read_text(encoding="utf-8")
        assert "url(http" not in text and "url(//" not in text and "@import" not in text, sheet


def test_all_pages_are_in_the_site_and_its_menu(site):
    pages = {f"{path.parent.name}/{path.stem}" for path in site}
    menu = (SOURCE / "docs/site/mkdocs.yml").read_text()
    for page in (SOURCE / "docs").rglob("*.md"):
        if page != SOURCE / "docs" / "index.md":
            assert f"{page.parent.name}/{page.stem}" in pages
            assert f": {page.relative_to(SOURCE / 'docs')}\n" in menu, f"{page} is not in the menu"
    for scenario in (SOURCE / "scenarios").glob("*.toml"):
        assert f"gallery/{scenario.stem}" in pages
    for notebook in (SOURCE / "docs" / "notebooks").glob("*.ipynb"):
        assert f"notebooks/{notebook.stem}" in pages
    text = {f"{path.parent.name}/{path.stem}": "".join(page.text) for path, page in site.items()}
    assert "a chemical bond that breaks" in text["catalogue/laws"]
    assert "Simulation.run" in text["catalogue/python"]
    assert "```" not in "".join(text.values()), "a code fence that Python-Markdown did not read"
