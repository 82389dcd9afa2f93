"""make.py OUT [--execute]: write the pages of the documentation's site to OUT, for mkdocs.

The site has all pages below docs/, a gallery of the scenarios, a catalogue made from `bzm show` and from docstrings, and
the notebooks. With --execute the notebooks are run; otherwise their stored outputs are shown."""

import base64
import html
import inspect
import json
import os
import pathlib
import re
import shutil
import sys
import tempfile
import tomllib

import boltzmann

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PAGES = {
    "README.md": "index.md", "docs/index.md": "documentation.md", "CONTRIBUTING.md": "develop/contributing.md",
    "CHANGELOG.md": "develop/changelog.md",
}  # fmt: skip
PAGES |= {
    str(path.relative_to(SOURCE)): str(path.relative_to(SOURCE / "docs"))
    for path in sorted((SOURCE / "docs").rglob("*.md")) if path != SOURCE / "docs" / "index.md"
}  # fmt: skip
# Scenarios with a replay on their page, and the values that make these runs short.
PLAYED = {
    "copper": {"output.trajectory": 20},
    "three-body": {"run.steps": 1265, "output.trajectory": 10},
    "cold-beams": {"output.trajectory": 12, "ensembles.0.number": 2048, "ensembles.1.number": 2048,
                   "ensembles.0.mass": 2.5049801370348908e-3, "ensembles.1.mass": 2.5049801370348908e-3,
                   "ensembles.0.charge": -2.5049801370348908e-3, "ensembles.1.charge": -2.5049801370348908e-3},
}  # fmt: skip
CATALOGUES = {
    "laws": "Laws", "classes": "Particle classes", "materials": "Materials", "diagnoses": "Diagnoses",
    "drawings": "Drawings", "loaders": "Loaders", "integrators": "Integrators", "dissipations": "Friction and noise",
    "units": "Units",
}  # fmt: skip


class Site:
    """The folder of pages, and the place of each source file in it."""

    def __init__(self, out):
        self.out = out
        self.linked_files = set()  # source files that pages link to, other than pages

    def place(self, path, page=""):
        """The path on the site of a source file."""
        path = pathlib.PurePosixPath(path)
        if str(path) in PAGES:
            return PAGES[str(path)]
        if path.suffix == ".ipynb":
            return f"notebooks/{path.stem}.md"
        if not (SOURCE / path).is_file():
            raise SystemExit(f"{page}: broken link: there is no {path}")
        self.linked_files.add(str(path))
        return f"images/{path.name}" if path.suffix in (".png", ".svg") else f"source/{path}.md"

    def linked(self, line, source, page):
        """The line with its links changed to paths of the site."""

        def moved(link):
            target, anchor = re.fullmatch(r"([^#]*)(#.*)?", link[1]).groups()
            if not target or re.match(r"\w+:", target) or (self.out / os.path.dirname(page) / target).is_file():
                return link[0]
            path = os.path.normpath(os.path.join(os.path.dirname(source), target))
            return f"]({os.path.relpath(self.place(path, source), os.path.dirname(page) or '.')}{anchor or ''})"

        return re.sub(r"\]\(([^)\s]+)\)", moved, line)

    def write(self, page, text):
        path = self.out / page
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def markdown(self, text, source, page):
        """Convert GitHub's Markdown for Python-Markdown: blank lines before lists and tables, one word after a fence."""
        lines, fenced, before = [], False, ""
        for line in text.splitlines():
            fence = re.match(r"\s*```(\w*)", line)
            if fence:
                line = line[: fence.end()]
                fenced = not fenced
            elif not fenced and not line.startswith("    "):
                block = re.match(r"[-*] |\d+\. |\|", line)
                goes_on = re.match(r"\|" if line.startswith("|") else r"\s|[-*] |\d+\. ", before)
                if block and before and not goes_on and not lines[-1].startswith("<!--"):
                    lines.append("")
                line = self.linked(line, source, page)
            lines.append(line)
            before = line
        self.write(page, "\n".join(lines) + "\n")

    def copy_linked_files(self):
        for path in sorted(self.linked_files):
            place = self.place(path)
            if place.startswith("images/"):
                (self.out / "images").mkdir(exist_ok=True)
                shutil.copyfile(SOURCE / path, self.out / place)
            else:
                language = {".hpp": "cpp", ".cpp": "cpp", ".toml": "toml"}.get(pathlib.Path(path).suffix, "text")
                self.write(place, f"# {path}\n\n```{language}\n{(SOURCE / path).read_text(encoding='utf-8')}```\n")


def plain(text):
    """Text with all markup characters escaped."""
    return re.sub(r"([\\`*_\[\]#|])", r"\\\1", html.escape(text, quote=False))


def documents(site):
    for path, page in PAGES.items():
        site.markdown((SOURCE / path).read_text(encoding="utf-8"), path, page)


def gallery(site):
    """A page for each shipped scenario, and an overview with all pictures."""
    overview = ["# Gallery", "", "These scenarios are part of Boltzmann. Run one with `bzm run NAME`, or in Python with "
                '`boltzmann.load("NAME").run()`.', "", '<div class="gallery">']  # fmt: skip
    for path in sorted((SOURCE / "scenarios").glob("*.toml")):
        name, text = path.stem, path.read_text(encoding="utf-8")
        scenario = tomllib.loads(text)
        picture = SOURCE / "docs" / "gallery" / f"{name}.png"
        (site.out / "gallery").mkdir(exist_ok=True)
        shutil.copyfile(picture, site.out / "gallery" / picture.name)
        title = plain(scenario["title"])
        image = f'<img src="{name}.png" alt="" loading="lazy">'
        overview.append(f'<a href="{name}.html">{image}{html.escape(scenario["title"])}</a>')
        site.write(f"gallery/{name}.md", "\n".join([
            f"# {title}", "", f"![{title}]({name}.png)", "", plain(scenario.get("description", "")), "",
            "```sh", f"bzm run {name}", "```", "", "```python", "import boltzmann as bz", "",
            f'sim = bz.load("{name}")', "sim.run()", "```", "", "## The scenario", "", "```toml", text.rstrip("\n"), "```", ""]))  # fmt: skip
    site.write("gallery/index.md", "\n".join([*overview, "</div>", ""]))


def replays(site):
    """Add a replay to the gallery pages of some scenarios."""
    for name, values in PLAYED.items():
        with tempfile.TemporaryDirectory() as folder:
            boltzmann.load(name, set=values).run(out=folder + "/run", progress=False)
            boltzmann.open(folder + "/run").replay(frames=64, megabytes=3).save(site.out / "gallery" / f"{name}-run.html")
        page = site.out / "gallery" / f"{name}.md"
        frame = f'<iframe src="{name}-run.html" width="100%" height="560" style="border:0" sandbox="allow-scripts" loading="lazy"></iframe>'
        text = page.read_text(encoding="utf-8")
        page.write_text(text.replace("## The scenario", f"## A run\n\n{frame}\n\n## The scenario", 1), encoding="utf-8")


def catalogue_pages(site):
    """The output of `bzm show` for each name."""
    for kind, title in CATALOGUES.items():
        catalogue = getattr(boltzmann, kind)
        lines = [f"# {title}", "", f"The output of `bzm show NAME` and of `boltzmann.{kind}[\"NAME\"]`.", ""]
        for name in catalogue:
            lines += [f"## {name}", "", "```text", str(catalogue[name]).rstrip("\n"), "```", ""]
        site.write(f"catalogue/{kind}.md", "\n".join(lines))


def documented(thing):
    return inspect.cleandoc(thing.__doc__ or "").replace("``", "`")


def signature(name, function, method):
    """The call without annotations: ``run(steps=None, time=None)``."""
    full = inspect.signature(function)
    parameters = [p.replace(annotation=p.empty) for p in list(full.parameters.values())[1 if method else 0 :]]
    return name + str(full.replace(parameters=parameters, return_annotation=inspect.Signature.empty))


def python_reference(site):
    """Every public name with its docstring."""
    from boltzmann import ensemble, measured, notebook, stored

    lines = ["# Python API", "", "All public names. [Python](../reference/python.md) has an overview with programs.", ""]
    things = {name: getattr(boltzmann, name) for name in boltzmann.__all__ if name != "exact"}
    others = [measured.Units, measured.Report, measured.Diagnosis, measured.Record,
              measured.Measured, measured.Mesh, measured.BoxEdges, stored.Trajectory, stored.StoredEnsemble, notebook.Window,
              notebook.Replay]  # fmt: skip
    functions = {name: thing for name, thing in things.items() if inspect.isfunction(thing)}
    first = [things["Simulation"], ensemble.Ensemble]
    classes = first + [one for one in [*things.values(), *others] if inspect.isclass(one) and one not in first]

    def of_function(heading, called, function):
        return [f"### {heading}", "", "```python", called, "```", "", documented(function), ""]

    lines += ["## Functions", ""]
    for name, function in functions.items():
        lines += of_function(name, f"boltzmann.{signature(name, function, False)}", function)
    kind = type(things["laws"])
    catalogues = ", ".join(f"`boltzmann.{name}`" for name, thing in things.items() if isinstance(thing, kind))
    lines += ["## Catalogues", "", f"{catalogues}: {documented(kind)}", ""]
    for one in classes:
        lines += [f"## {one.__name__}", "", documented(one), ""]
        for name, member in vars(one).items():
            if name.startswith("_"):
                continue
            if inspect.isfunction(member):
                lines += of_function(f"{one.__name__}.{name}", signature(name, member, True), member)
            elif isinstance(member, property):
                lines += of_function(f"{one.__name__}.{name}", name, member)
    lines += ["## boltzmann.exact", "", documented(boltzmann.exact), ""]
    for name, function in vars(boltzmann.exact).items():
        if inspect.isfunction(function) and not name.startswith("_"):
            lines += of_function(f"exact.{name}", signature(name, function, False), function)
    site.write("catalogue/python.md", "\n".join(lines))


def executed(path):
    import nbclient
    import nbformat

    os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # suppress a warning about the kernel's own modules
    book = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(book, timeout=120, kernel_name="python3").execute()
    return book


def shown(out, name, number, site):
    """An output of a cell: a picture, or text."""
    if out["output_type"] == "stream":
        return ["```text", "".join(out["text"]).rstrip("\n"), "```", ""] if out["name"] == "stdout" else []
    data = out.get("data", {})
    if "image/png" in data:
        picture = f"{name}-{number}.png"
        (site.out / "notebooks").mkdir(exist_ok=True)
        (site.out / "notebooks" / picture).write_bytes(base64.b64decode(data["image/png"]))
        return [f"![output of the cell]({picture})", ""]
    text = "".join(data.get("text/plain", ""))
    has_no_content = not text or re.match(r" *\d+ %  step |Text\(|<matplotlib|<Figure", text)
    return [] if has_no_content else ["```text", text, "```", ""]


def notebooks(site, execute):
    for path in sorted((SOURCE / "docs" / "notebooks").glob("*.ipynb")):
        book = executed(path) if execute else json.loads(path.read_text(encoding="utf-8"))
        lines = []
        for number, cell in enumerate(book["cells"]):
            text = "".join(cell["source"])
            if cell["cell_type"] == "markdown":
                lines += [text, ""]
                if number == 0:
                    lines += [f"This notebook is `docs/notebooks/{path.name}`. "
                              "[Use Python](../how-to/use-python.md) explains how to open it.", ""]  # fmt: skip
                continue
            lines += ["```python", text, "```", ""]
            for out in cell["outputs"]:
                lines += shown(out, path.stem, number, site)
        site.markdown("\n".join(lines), f"docs/notebooks/{path.name}", f"notebooks/{path.stem}.md")


def main():
    out = pathlib.Path(sys.argv[1])
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    site = Site(out)
    documents(site)
    gallery(site)
    replays(site)
    catalogue_pages(site)
    python_reference(site)
    notebooks(site, "--execute" in sys.argv[2:])
    site.copy_linked_files()
    shutil.copy(pathlib.Path(__file__).with_name("site.css"), out)


main()
