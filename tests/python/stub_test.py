"""The stub of the compiled module, _core.pyi, says what the module has: the same names, with as many arguments."""

import ast
import inspect
import os
import re

import boltzmann
from boltzmann import _core


def arguments(signature):
    """Of what pybind11 says of a function; None, where it says nothing."""
    found = re.match(r"\w+\((.*)\) -> ", (signature or "").split("\n")[0])
    return found and len(re.findall(r"(?:^|, )\w+: ", found[1]))


def compiled():
    names = {}
    for name, thing in vars(_core).items():
        if name.startswith("__"):
            continue
        names[name] = arguments(thing.__doc__) if callable(thing) and not inspect.isclass(thing) else None
        if inspect.isclass(thing):
            for method, function in vars(thing).items():
                if not method.startswith("_") or (method == "__init__" and arguments(function.__doc__)):
                    names[f"{name}.{method}"] = arguments(function.__doc__)
    return names


def stubbed():
    names = {}

    def add(body, before):
        for node in body:
            if isinstance(node, ast.FunctionDef):
                names[before + node.name] = len(node.args.args)
            elif isinstance(node, ast.AnnAssign):
                names[node.target.id] = None
            elif isinstance(node, ast.ClassDef):
                names[node.name] = None
                add(node.body, node.name + ".")

    with open(os.path.join(os.path.dirname(boltzmann.__file__), "_core.pyi"), encoding="utf-8") as stub:
        add(ast.parse(stub.read()).body, "")
    return names


def test_the_stub_is_right():
    assert stubbed() == compiled()


def test_the_package_says_that_it_has_types():
    assert os.path.exists(os.path.join(os.path.dirname(boltzmann.__file__), "py.typed"))


def test_every_public_name_has_a_docstring():
    for name in boltzmann.__all__:
        thing = getattr(boltzmann, name)
        assert (thing.__doc__ or "").strip(), name
        if inspect.isclass(thing):
            for method, function in vars(thing).items():
                if not method.startswith("_") and callable(function):
                    assert (function.__doc__ or "").strip(), f"{name}.{method}"
