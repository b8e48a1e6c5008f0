# SPDX-License-Identifier: Apache-2.0
"""The reference of the Python package, from its source: nothing has to be built."""

import ast

from docstrings import escaped, markdown

WIDTH = 100  # of a signature on one line
MADE = {"ColorMap", "Movie", "Picture", "Points", "View"}  # by functions: users do not call the constructors


def _signature(function, name, is_method):
    arguments = function.args
    if is_method and arguments.args and arguments.args[0].arg in ("self", "cls"):
        arguments.args = arguments.args[1:]
    listed = ast.unparse(arguments)
    returns = f" -> {ast.unparse(function.returns)}" if function.returns and name[0].islower() else ""
    line = f"{name}({listed}){returns}"
    if len(line) <= WIDTH:
        return line
    # One argument a line: split at the commas outside of brackets.
    parts, depth = [""], 0
    for character in listed:
        depth += {"[": 1, "(": 1, "{": 1, "]": -1, ")": -1, "}": -1}.get(character, 0)
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return f"{name}(\n" + "".join(f"    {part.strip()},\n" for part in parts) + f"){returns}"


def _code(text):
    return f"```python\n{text}\n```\n"


def _has_decorator(function, *names):
    return any(ast.unparse(decorator).split(".")[-1].split("(")[0] in names for decorator in function.decorator_list)


def _properties(functions):
    """A table of the properties of a class."""
    rows = []
    for item in functions:
        if _has_decorator(item, "property"):
            kind = f"`{ast.unparse(item.returns)}`" if item.returns else ""
            text = " ".join((ast.get_docstring(item) or "").split())
            rows.append(f"| `{item.name}` | {kind.replace('|', 'or')} | {escaped(text)} |")
    return ["| property | type | |\n|---|---|---|\n" + "\n".join(rows) + "\n"] if rows else []


def _method(owner, item):
    is_method = not _has_decorator(item, "staticmethod")
    prefix = f"{owner}." if _has_decorator(item, "staticmethod", "classmethod") else ""
    return [f"#### `{owner}.{item.name}()`\n", _code(_signature(item, prefix + item.name, is_method)), markdown(ast.get_docstring(item))]


def _class(node):
    bases = [ast.unparse(base) for base in node.bases if not ast.unparse(base).startswith("_")]
    out = [f"### `{node.name}`\n"]
    functions = [item for item in node.body if isinstance(item, ast.FunctionDef)]
    makers = [item for item in functions if item.name == "__init__" and "Error" not in "".join(bases) and node.name not in MADE]
    fields = [ast.unparse(item) for item in node.body if isinstance(item, ast.AnnAssign) and not item.target.id.startswith("_")]
    if makers:
        out.append(_code(_signature(makers[0], node.name, True)))
    elif fields:
        out.append(_code(f"{node.name}\n" + "\n".join("    " + field for field in fields)))
    else:
        out.append(_code(f"class {node.name}({', '.join(bases)})" if bases else f"class {node.name}"))
    out.append(markdown(ast.get_docstring(node)))
    if makers and ast.get_docstring(makers[0]):
        out.append(markdown(ast.get_docstring(makers[0])))
    public = [item for item in functions if not item.name.startswith("_")]
    out += _properties(public)
    for item in public:
        if not _has_decorator(item, "property", "setter", "overload"):
            out += _method(node.name, item)
    return out


def _is_documented(node):
    return isinstance(node, (ast.FunctionDef, ast.ClassDef)) and ast.get_docstring(node)


def page(package):
    """Returns the Markdown of the names in __all__ of the files of the package in this folder.

    Errors     SystemExit if one of them has no docstring
    """
    nodes, names = {}, []
    for file in sorted(package.glob("*.py")):
        for node in ast.parse(file.read_text()).body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                nodes[node.name] = node
            if isinstance(node, ast.Assign) and node.targets[0].id == "__all__":
                names += ast.literal_eval(node.value)
    names.sort()
    module = ast.parse((package / "__init__.py").read_text())
    constants = [item for item in module.body if isinstance(item, ast.AnnAssign) and item.target.id in names]
    bare = [name for name in names if name not in {item.target.id for item in constants} and not _is_documented(nodes.get(name))]
    if bare:
        raise SystemExit(f"{package}: no docstring: {', '.join(bare)}")

    out = ["# Python reference\n", "Every function and class of `import orrery`, from its docstrings; [Python](python.md) is the introduction.\n"]
    is_error = lambda name: name.endswith(("Error", "Warning"))
    functions = [name for name in names if isinstance(nodes.get(name), ast.FunctionDef)]
    classes = [name for name in names if isinstance(nodes.get(name), ast.ClassDef) and not is_error(name)]
    out.append("## Functions\n")
    for name in functions:
        out += [f"### `{name}()`\n", _code(_signature(nodes[name], name, False)), markdown(ast.get_docstring(nodes[name]))]
    out.append("## Classes\n")
    for name in classes:
        out += _class(nodes[name])
    out.append("## Errors\n")
    for name in filter(is_error, names):
        out += _class(nodes[name])
    out.append("## Constants\n")
    out += [_code("\n".join(ast.unparse(item.target) + ": " + ast.unparse(item.annotation) for item in constants))]
    return "\n".join(out)
