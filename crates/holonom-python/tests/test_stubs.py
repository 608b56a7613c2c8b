"""What type checkers see is what there is."""

import ast
import pathlib
import runpy

import holonom
from holonom import _builders, _engine

FOLDER = pathlib.Path(__file__).parents[1]
PACKAGE = FOLDER / "python" / "holonom"


def test_the_stub_of_the_builders_is_that_of_the_definitions():
    stub = runpy.run_path(str(FOLDER / "stubs.py"))["stub"]()
    assert (PACKAGE / "_builders.pyi").read_text(encoding="utf-8") == stub, "run python crates/holonom-python/stubs.py"
    ast.parse(stub)


def test_the_stub_of_the_module_names_what_it_has():
    tree = ast.parse((PACKAGE / "_engine.pyi").read_text(encoding="utf-8"))
    functions = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    constants = {node.target.id for node in tree.body if isinstance(node, ast.AnnAssign)}
    assert functions | constants | set(classes) == {name for name in dir(_engine) if not name.startswith("_")}
    for name, node in classes.items():
        targets = (part.target.id if isinstance(part, ast.AnnAssign) else part.name for part in node.body)
        known = {part for part in targets if not part.startswith("_")}
        assert known == {part for part in dir(getattr(_engine, name)) if not part.startswith("_")}, name


def test_all_that_is_public_is_named_once():
    assert len(set(holonom.__all__)) == len(holonom.__all__) and set(_builders.__all__) <= set(holonom.__all__)
    assert all(hasattr(holonom, name) for name in holonom.__all__)
    # As type checkers read it.
    tree = ast.parse((PACKAGE / "__init__.py").read_text(encoding="utf-8"))
    lists = [node.value for node in tree.body if isinstance(node, (ast.Assign, ast.AugAssign)) and isinstance(node.value, ast.List)]
    assert [name.value for part in lists for name in part.elts] == holonom.__all__


def test_the_package_is_typed_where_it_is_installed():
    installed = pathlib.Path(holonom.__file__).parent
    assert (installed / "py.typed").exists() and (installed / "_builders.pyi").exists()
