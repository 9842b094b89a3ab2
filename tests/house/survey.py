"""What the house rules ask of the code, found by reading it: nothing of selfconf or sim is imported.

What does not keep to a rule yet is excused line by line in a text file beside this module, as `subject: reason`. The
files may only shrink: a new line is not added, and one that excuses nothing is deleted.

    python -m tests.house.survey

deletes the lines that excuse nothing any more.
"""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
MOST_BRANCHES = 15
"""The greatest cyclomatic complexity of a function that has no comment `# complexity: ...` before it."""
CONVENTIONS = {
    "EXAMPLE": "each command has its example",
    "add_arguments": "each command declares its arguments",
    "run": "each command is run",
    "main": "each program is entered there",
    "log": "each module has its logger",
    "render": "each format of a report is written by its module",
}
"""Names that may stand in several modules because each means one thing everywhere."""
NOT_IN_GLOSSARY = {
    "selfconf/errors.py": "each error says in its own text what happened",
    "sim/pictures/": "drawing, in the words of the field",
}
"""Modules and folders whose classes the glossary need not define, and why."""


def modules(*tops: str) -> Iterator[tuple[str, ast.Module]]:
    """The path from the root, and the syntax tree, of each module below some packages."""
    for top in tops:
        for path in sorted((ROOT / top).rglob("*.py")):
            yield path.relative_to(ROOT).as_posix(), _tree(path.read_text("utf-8"))


_tree = cache(ast.parse)


def complex_functions() -> dict[str, str]:
    """Each function with too many branches and no comment that says why, with its complexity."""
    from radon.complexity import cc_visit_ast

    found = {}
    for path, tree in modules("selfconf", "sim"):
        lines = (ROOT / path).read_text("utf-8").splitlines()
        branched = ast.Module([node for node in tree.body if _may_branch_much(node, lines)], [])
        first = {node.lineno: _first_line(node) for node in ast.walk(branched) if isinstance(node, FUNCTION)}
        for block in cc_visit_ast(branched):
            before = lines[first[block.lineno] - 2] if block.lineno in first else ""
            if (
                block.letter in "FM"
                and block.complexity > MOST_BRANCHES
                and not before.lstrip().startswith("# complexity:")
            ):
                found[f"{path}::{block.fullname}"] = str(block.complexity)
    return found


_BRANCHING = re.compile(r"\b(?:if|elif|else|for|while|and|or|except|case|assert)\b")
"""The words of which radon counts each as one branch more, if as any."""


def _may_branch_much(node: ast.stmt, lines: list[str]) -> bool:
    """Whether a definition has as many words of branches as a function with too many has: few have, and are visited."""
    return len(_BRANCHING.findall("\n".join(lines[node.lineno - 1 : node.end_lineno]))) >= MOST_BRANCHES


FUNCTION = (ast.FunctionDef, ast.AsyncFunctionDef)


def _first_line(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """The line of a function's first decorator, or of its `def`."""
    return min([function.lineno, *(decorator.lineno for decorator in function.decorator_list)])


def public_names(tree: ast.Module) -> Iterator[str]:
    """The classes, functions and constants that a module defines at its top level, without a leading underscore."""
    for node in tree.body:
        names: list[str] = []
        if isinstance(node, (ast.ClassDef, *FUNCTION)):
            names = [node.name]
        elif isinstance(node, ast.Assign):
            names = [target.id for target in node.targets if isinstance(target, ast.Name)]
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names = [node.target.id]
        yield from (name for name in names if not name.startswith("_"))


def shared_names() -> dict[str, str]:
    """Each public name of selfconf that several modules define, with these modules."""
    where: dict[str, set[str]] = defaultdict(set)
    for path, tree in modules("selfconf"):
        for name in public_names(tree):
            where[name].add(path)
    return {
        name: ", ".join(sorted(paths))
        for name, paths in sorted(where.items())
        if len(paths) > 1 and name not in CONVENTIONS
    }


def dependent_docstrings() -> dict[str, str]:
    """Each docstring that begins with "The same", so that it cannot be read alone."""
    found = {}
    for path, tree in modules("selfconf", "sim"):
        if "The same" not in (ROOT / path).read_text("utf-8"):
            continue  # a walk through every module would take long
        for node in ast.walk(tree):
            if isinstance(node, (ast.Module, ast.ClassDef, *FUNCTION)):
                text = ast.get_docstring(node) or ""
                if text.startswith("The same"):
                    found[f"{path}::{getattr(node, 'name', '')}"] = text.partition("\n")[0]
    return found


def undefined_classes() -> dict[str, str]:
    """Each public class of selfconf and sim that the glossary does not define, with its module.

    The glossary defines a class by a row about its name in words (`DeploymentRecord`: "deployment record") or by
    the name itself, in backticks.
    """
    page = (ROOT / "docs" / "glossary.md").read_text("utf-8")
    rows = {row.strip().lower() for row in re.findall(r"^\|([^|]*)\|", page, re.MULTILINE)}
    quoted = set(re.findall(r"`(\w+)`", page))
    found: dict[str, list[str]] = defaultdict(list)
    for path, tree in modules("selfconf", "sim"):
        for node in tree.body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", node.name).lower()
                if words not in rows and node.name not in quoted and not path.startswith(tuple(NOT_IN_GLOSSARY)):
                    found[node.name].append(path)
    return {name: ", ".join(paths) for name, paths in sorted(found.items())}


_PERSONS = re.compile(
    r"\b(?:nobody|somebody|who(?:m(?:ever)?|ever)|those\s+who|(?:is|are|was|were|be|been|being)\s+told|nought)\b",
    re.IGNORECASE,
)
"""Words that speak of components and programs as of people, where the field has a noun or another verb."""


def persons_for_parts() -> dict[str, str]:
    """Each word that makes a person of a component or a program, by file, with the lines where it stands."""
    found: dict[str, list[str]] = defaultdict(list)
    for top in ("selfconf", "sim"):
        for path in sorted(path for path in (ROOT / top).rglob("*") if path.suffix in (".py", ".js", ".html")):
            text = path.read_text("utf-8")
            for match in _PERSONS.finditer(text):
                words = " ".join(match.group().lower().split())
                found[f"{path.relative_to(ROOT).as_posix()}::{words}"].append(
                    str(text.count("\n", 0, match.start()) + 1)
                )
    return {subject: "line " + ", ".join(lines) for subject, lines in sorted(found.items())}


_OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]*")
_TO_TYPE = re.compile(r"(?:selfconf [a-z]+|`run )[^`]*")
"""A whole command that a user may type, with what follows."""


def options_in_messages() -> dict[str, str]:
    """Each option of the command line that a text of selfconf outside of its `cli` names, with the lines.

    The library says it by `selfconf.model.setting_names`. A whole command, and an argument of a program, may stand.
    """
    found: dict[str, list[str]] = defaultdict(list)
    for path, tree in modules("selfconf"):
        if path.startswith("selfconf/cli/") or "--" not in (ROOT / path).read_text("utf-8"):
            continue
        docstrings = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docstrings:
                said = "" if re.fullmatch(r"--\S+", node.value) else _TO_TYPE.sub("", node.value)
                for option in _OPTION.findall(said):
                    found[f"{path}::{option}"].append(str(node.lineno))
    return {subject: "line " + ", ".join(lines) for subject, lines in sorted(found.items())}


RULES: dict[str, Callable[[], dict[str, str]]] = {
    "complexity": complex_functions,
    "names": shared_names,
    "docstrings": dependent_docstrings,
    "glossary": undefined_classes,
    "persons": persons_for_parts,
    "options": options_in_messages,
}
"""What does not keep to each rule; the excuses are in the text file of that name."""


def excuses(rule: str) -> dict[str, str]:
    """The subjects that are excused from a rule, each with the reason."""
    lines = (line for line in (HERE / f"{rule}.txt").read_text("utf-8").splitlines() if not line.startswith("#"))
    return {subject: reason for subject, _, reason in (line.rpartition(": ") for line in lines) if subject}


def shrink(rule: str) -> int:
    """Delete the excuses that are not needed any more; return how many."""
    path, needed = HERE / f"{rule}.txt", RULES[rule]()
    lines = path.read_text("utf-8").splitlines(keepends=True)
    kept = [line for line in lines if line.startswith("#") or line.rpartition(": ")[0] in needed]
    path.write_text("".join(kept), "utf-8")
    return len(lines) - len(kept)


if __name__ == "__main__":
    for name in RULES:
        print(f"{name}: {shrink(name)} deleted")
