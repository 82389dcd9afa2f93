"""make.py OUT [--execute]: the pages of the documentation's site, for mkdocs, in OUT.

The guide with links that hold there, a gallery of the scenarios, a reference of what `bzm show` and docstrings tell, and
the notebooks: with --execute as they come out of a kernel, else as they are stored."""

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
    "README.md": "index.md", "docs/architecture.md": "architecture.md", "docs/where-to-add.md": "where-to-add.md", "CONTRIBUTING.md": "contributing.md",
    "CHANGELOG.md": "changelog.md",
}  # fmt: skip
# Scenarios whose page plays them, and what makes the run short enough for that.
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
    """The folder of pages, and where each file of the source is in it."""

    def __init__(self, out):
        self.out = out
        self.asked = set()  # files of the source that a page has linked to, beside the pages

    def place(self, path):
        """Of a file of the source on the site."""
        path = pathlib.PurePosixPath(path)
        if str(path) in PAGES:
            return PAGES[str(path)]
        if path.suffix == ".md" and path.parts[:2] == ("docs", "guide"):
            return f"guide/{path.name}"
        if path.suffix == ".ipynb":
            return f"notebooks/{path.stem}.md"
        if not (SOURCE / path).is_file():
            raise SystemExit(f"there is no {path}, which a page links to")
        self.asked.add(str(path))
        return f"images/{path.name}" if path.suffix in (".png", ".svg") else f"source/{path}.md"

    def linked(self, line, source, page):
        """A line whose links lead to where their files are on the site."""

        def moved(link):
            target, anchor = re.fullmatch(r"([^#]*)(#.*)?", link[1]).groups()
            if not target or re.match(r"\w+:", target) or (self.out / os.path.dirname(page) / target).is_file():
                return link[0]
            path = os.path.normpath(os.path.join(os.path.dirname(source), target))
            return f"]({os.path.relpath(self.place(path), os.path.dirname(page) or '.')}{anchor or ''})"

        return re.sub(r"\]\(([^)\s]+)\)", moved, line)

    def write(self, page, text):
        path = self.out / page
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def markdown(self, text, source, page):
        """As GitHub reads it -> as Python-Markdown does: blank lines before lists and tables, one word behind a fence."""
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

    def copy_what_was_asked_for(self):
        for path in sorted(self.asked):
            place = self.place(path)
            if place.startswith("images/"):
                (self.out / "images").mkdir(exist_ok=True)
                shutil.copyfile(SOURCE / path, self.out / place)
            else:
                language = {".hpp": "cpp", ".cpp": "cpp", ".toml": "toml"}.get(pathlib.Path(path).suffix, "text")
                self.write(place, f"# {path}\n\n```{language}\n{(SOURCE / path).read_text(encoding='utf-8')}```\n")


def plain(text):
    """Text in which nothing is marked up."""
    return re.sub(r"([\\`*_\[\]#|])", r"\\\1", html.escape(text, quote=False))


def guide(site):
    for path, page in PAGES.items():
        site.markdown((SOURCE / path).read_text(encoding="utf-8"), path, page)
    for path in sorted((SOURCE / "docs" / "guide").glob("*.md")):
        site.markdown(path.read_text(encoding="utf-8"), f"docs/guide/{path.name}", f"guide/{path.name}")


def gallery(site):
    """A page for each scenario, and one with the pictures of all."""
    overview = ["# Gallery", "", "Each is a scenario that comes with Boltzmann: `bzm run NAME`, or "
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
    """A run of some scenarios as a page that plays, in their pages of the gallery."""
    for name, values in PLAYED.items():
        with tempfile.TemporaryDirectory() as folder:
            boltzmann.load(name, set=values).run(out=folder + "/run", progress=False)
            boltzmann.open(folder + "/run").replay(frames=64, megabytes=3).save(site.out / "gallery" / f"{name}-run.html")
        page = site.out / "gallery" / f"{name}.md"
        frame = f'<iframe src="{name}-run.html" width="100%" height="560" style="border:0" sandbox="allow-scripts" loading="lazy"></iframe>'
        text = page.read_text(encoding="utf-8")
        page.write_text(text.replace("## The scenario", f"## A run\n\n{frame}\n\n## The scenario", 1), encoding="utf-8")


def reference(site):
    """What `bzm show` tells of each name."""
    for kind, title in CATALOGUES.items():
        catalogue = getattr(boltzmann, kind)
        lines = [f"# {title}", "", f"What `bzm show NAME` and `boltzmann.{kind}[\"NAME\"]` tell.", ""]
        for name in catalogue:
            lines += [f"## {name}", "", "```text", str(catalogue[name]).rstrip("\n"), "```", ""]
        site.write(f"reference/{kind}.md", "\n".join(lines))


def documented(thing):
    return inspect.cleandoc(thing.__doc__ or "").replace("``", "`")


def signature(name, function, method):
    """As one calls it: ``run(steps=None, time=None)``."""
    told = inspect.signature(function)
    parameters = [p.replace(annotation=p.empty) for p in list(told.parameters.values())[1 if method else 0 :]]
    return name + str(told.replace(parameters=parameters, return_annotation=inspect.Signature.empty))


def python_reference(site):
    """Every public name and what its docstring says."""
    from boltzmann import ensemble, measured, notebook, stored

    lines = ["# Python, name by name", "", "Beside the [guide](../guide/python.md), which has programs.", ""]
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
    site.write("reference/python.md", "\n".join(lines))


def executed(path):
    import nbclient
    import nbformat

    os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # else the kernel warns of its own modules
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
        return [f"![what the cell shows]({picture})", ""]
    text = "".join(data.get("text/plain", ""))
    says_nothing = not text or re.match(r" *\d+ %  step |Text\(|<matplotlib|<Figure", text)
    return [] if says_nothing else ["```text", text, "```", ""]


def notebooks(site, execute):
    for path in sorted((SOURCE / "docs" / "notebooks").glob("*.ipynb")):
        book = executed(path) if execute else json.loads(path.read_text(encoding="utf-8"))
        lines = []
        for number, cell in enumerate(book["cells"]):
            text = "".join(cell["source"])
            if cell["cell_type"] == "markdown":
                lines += [text, ""]
                if number == 0:
                    lines += [f"The notebook is `docs/notebooks/{path.name}`; "
                              "[Python](../guide/python.md#notebooks) says how to open it.", ""]  # fmt: skip
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
    guide(site)
    gallery(site)
    replays(site)
    reference(site)
    python_reference(site)
    notebooks(site, "--execute" in sys.argv[2:])
    site.copy_what_was_asked_for()
    shutil.copy(pathlib.Path(__file__).with_name("site.css"), out)


main()
