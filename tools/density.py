"""Count what makes Python code hard to read at first sight: `python tools/density.py`.

It exits with 1 where flowtex exceeds one of LIMITS. Lower a limit when the code improves. Lines of
code are those with code on them: docstrings, comments and blank lines do not count.
"""

from __future__ import annotations

import ast
import io
import sys
import tokenize
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

#: Greatest numbers in flowtex.
LIMITS = {
    "comprehensions": 19.5,
    "conditional expressions": 4.7,
    "parallel assignments": 0.8,
    "bodies over 40 lines": 11.0,
    "nested comprehensions": 40.0,
    "nested conditional expressions": 3.0,
}
#: Of these the number for each 1,000 lines of code is limited.
PER_THOUSAND_LINES = ("comprehensions", "conditional expressions", "parallel assignments")
#: Least share of the public functions with a `raise` whose docstring has a section Raises.
LEAST_DOCUMENTED = 0.95
LONGEST_BODY = 40

Function = ast.FunctionDef | ast.AsyncFunctionDef
Comprehension = ast.ListComp | ast.SetComp | ast.DictComp | ast.GeneratorExp

#: Tokens that are no code.
LAYOUT = (
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENDMARKER,
)


def lines_of_code(source: str, nodes: list[ast.AST]) -> int:
    """Return the number of lines that contain code, given the text of a module and its nodes."""
    code: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type not in LAYOUT:
            code.update(range(token.start[0], token.end[0] + 1))
    for node in nodes:
        if not (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)):
            continue
        if isinstance(node.value.value, str):
            last_line = node.end_lineno or node.lineno
            code.difference_update(range(node.lineno, last_line + 1))
    return len(code)


def is_nested(node: Comprehension) -> bool:
    """Return whether a comprehension has two loops, or contains another one."""
    if len(node.generators) > 1:
        return True
    comprehensions = [inner for inner in ast.walk(node) if isinstance(inner, Comprehension)]
    return len(comprehensions) > 1


def body_length(function: Function) -> int:
    """Return the number of lines from the signature, or the docstring, to the end."""
    start = function.lineno
    if ast.get_docstring(function):
        start = function.body[0].end_lineno or start
    return (function.end_lineno or start) - start


def counted_kinds(node: ast.AST) -> Iterator[str]:
    """Yield the keys of LIMITS of which a node is one."""
    if isinstance(node, Comprehension):
        yield "comprehensions"
        if is_nested(node):
            yield "nested comprehensions"
    elif isinstance(node, ast.IfExp):
        yield "conditional expressions"
        if any(isinstance(part, ast.IfExp) for part in (node.test, node.body, node.orelse)):
            yield "nested conditional expressions"
    elif isinstance(node, ast.Assign):
        if isinstance(node.targets[0], ast.Tuple) and isinstance(node.value, ast.Tuple):
            yield "parallel assignments"
    elif isinstance(node, Function) and body_length(node) > LONGEST_BODY:
        yield "bodies over 40 lines"


def public_functions(tree: ast.Module) -> Iterator[Function]:
    """Yield the public functions of a module, and the public methods of its public classes."""
    for node in tree.body:
        members: list[ast.stmt] = [node]
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            members = node.body
        for member in members:
            if isinstance(member, Function) and not member.name.startswith("_"):
                yield member


def raises_error(function: Function) -> bool:
    """Return whether a function has a `raise`, or calls `raise_faults`."""
    for node in ast.walk(function):
        if isinstance(node, ast.Raise):
            return True
        called = getattr(node, "func", None)
        if isinstance(called, ast.Name) and called.id == "raise_faults":
            return True
    return False


@dataclass
class Density:
    """The numbers of a package."""

    counts: Counter[str] = field(default_factory=Counter)  #: How often it has each key of LIMITS.
    code: int = 0  #: Lines of code.
    raising: int = 0  #: Public functions that raise an error.
    #: Places and names of those functions whose docstring has no section Raises.
    undocumented: list[str] = field(default_factory=list)

    def add(self, path: Path, *, private: bool) -> None:
        """Count a module; the functions of a private one are not public."""
        source = path.read_text(encoding="utf-8")
        tree = ast.parse(source)
        nodes = list(ast.walk(tree))
        self.code += lines_of_code(source, nodes)
        for node in nodes:
            for kind in counted_kinds(node):
                self.counts[kind] += 1
        if private:
            return
        for function in public_functions(tree):
            if not raises_error(function):
                continue
            self.raising += 1
            docstring = ast.get_docstring(function) or ""
            if "Raises\n------" not in docstring:
                self.undocumented.append(f"{path}:{function.lineno} {function.name}")

    def number(self, kind: str) -> float:
        """Return the number that is compared with a limit."""
        if kind in PER_THOUSAND_LINES:
            return 1000 * self.counts[kind] / max(self.code, 1)
        return float(self.counts[kind])

    def faults(self) -> list[str]:
        """Return a sentence for each limit that is exceeded."""
        sentences: list[str] = []
        for kind, limit in LIMITS.items():
            if self.number(kind) > limit:
                sentences.append(
                    f"{self.number(kind):.4g} {kind}; expected at most {limit:g}: name "
                    "intermediate results, and write branches as if statements"
                )
        if len(self.undocumented) > (1 - LEAST_DOCUMENTED) * self.raising:
            sentences.append(
                f"{len(self.undocumented)} of {self.raising} public functions that raise an error "
                f"have no section Raises; expected at most {1 - LEAST_DOCUMENTED:.0%}: add it to "
                f"{', '.join(self.undocumented)}"
            )
        return sentences


def measure(package: Path) -> Density:
    """Return the numbers of a package."""
    density = Density()
    for path in sorted(package.rglob("*.py")):
        folders = path.relative_to(package).parts[:-1]
        is_private = any(folder.startswith("_") for folder in folders)
        density.add(path, private=is_private)
    return density


def main(package: Path) -> int:
    """Write the numbers and the faults; return the exit code."""
    density = measure(package)
    for kind, limit in LIMITS.items():
        sys.stdout.write(f"{density.number(kind):6.1f} {kind}, limit {limit:g}\n")
    documented = density.raising - len(density.undocumented)
    sys.stdout.write(f"{documented} of {density.raising} public functions that raise say so\n")
    faults = density.faults()
    sys.stderr.writelines(f"{fault}\n" for fault in faults)
    return int(bool(faults))


if __name__ == "__main__":
    sys.exit(main(Path("flowtex")))
