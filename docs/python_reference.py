"""The page of the Python package, from its docstrings: python_reference.py FOLDER writes FOLDER/hextwist.html."""

import html
import importlib
import inspect
import pathlib
import re
import sys
import types

HEAD = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>hextwist for Python</title>
<meta name="viewport" content="width=device-width">
<style>
{theme}
body {{ margin: 0 auto; max-width: 60em; padding: 1em 1.5em 4em; }}
h1, h2, h3 {{ font-weight: 600; }}
h2 {{ border-bottom: 1px solid var(--line); margin-top: 2.5em; }}
code, pre {{ font: 14px/1.5 var(--font-family-monospace); }}
pre, nav, dt {{ background: var(--raised); padding: 0.4em 0.8em; }}
pre {{ overflow: auto; }}
dt {{ border-left: 3px solid var(--line); margin-top: 1.2em; overflow-wrap: anywhere; }}
dd {{ margin: 0.4em 0 0 1em; }}
dd p {{ margin: 0.3em 0; }}
a {{ text-decoration: none; }}
</style></head><body>
<h1>hextwist for Python</h1>
<p>Shapes, units and lifetimes across languages are in <code>docs/embedding.md</code>, the words of commands in
<code>docs/commands.md</code>. C++ and C: <a href="../cpp/index.html">the other half of this reference</a>.</p>
"""


def public(thing):
    """(name, object) of what a module or class shows."""
    names = getattr(thing, "__all__", vars(thing))
    return [(name, inspect.getattr_static(thing, name)) for name in names if not name.startswith("_")]


def said(thing):
    """(signature, text). pybind11 puts the signature on the first line of the docstring."""
    doc = inspect.getdoc(thing) or ""
    bound = re.match(r"\w+(\(.*\) -> .*)\n*", doc)
    if bound:
        doc, signature = doc[bound.end() :], re.sub(r"\(self: [\w.]+(, )?", "(", bound[1])
    elif inspect.isfunction(thing):
        signature = re.sub(r"\(self(: [\w.]+)?(, )?", "(", str(inspect.signature(thing)))
    else:
        signature = ""
    signature = re.sub(r"<built-in function (\w+)>", r"\1", signature)
    return signature.replace("_core.", "").replace("typing.", ""), doc


def paragraphs(text):
    """What is indented is code, as in the docstrings of modules."""
    for block in re.split(r"\n\s*\n", text):
        tag = "pre" if block.startswith("    ") else "p"
        yield f"<{tag}>{html.escape(inspect.cleandoc(block))}</{tag}>"


def entry(path, name, thing):
    signature, doc = said(thing)
    yield f'<dt id="{path}.{name}"><code><b>{name}</b>{html.escape(signature)}</code></dt>'
    yield f"<dd>{''.join(paragraphs(doc))}</dd>"


def class_of(path, thing):
    yield f'<h3 id="{path}">class {path}</h3>'
    yield from paragraphs(said(thing)[1])
    yield "<dl>"
    signature, doc = said(thing.__init__)
    if signature and doc:  # nobody is to make the others
        yield f'<dt><code><b>{thing.__name__}</b>{html.escape(signature.split(" -> ")[0])}</code></dt>'
        yield f"<dd>{''.join(paragraphs(doc))}</dd>"
    for name, member in public(thing):
        yield from entry(path, name, member)
    yield "</dl>"


def module_of(module):
    path = module.__name__
    yield f'<h2 id="{path}">{path}</h2>'
    yield from paragraphs(module.__doc__.strip())  # getdoc() would take code for text
    classes = [(name, thing) for name, thing in public(module) if inspect.isclass(thing)]
    others = [(name, thing) for name, thing in public(module) if not inspect.isclass(thing)]
    links = " &middot; ".join(f'<a href="#{path}.{name}">{name}</a>' for name, _ in classes + others)
    yield f"<nav>{links}</nav>"
    for name, thing in classes:
        yield from class_of(f"{path}.{name}", thing)
    if others:
        yield "<dl>"
        for name, thing in others:
            yield from entry(path, name, thing)
        yield "</dl>"


def main(folder):
    try:
        import gmsh  # noqa: F401
    except ImportError:  # it is asked for nothing before a function is called
        sys.modules["gmsh"] = types.ModuleType("gmsh")
    theme = (pathlib.Path(__file__).parent / "reference.css").read_text()
    page = [HEAD.format(theme=theme)]
    for name in ("hextwist", "hextwist.gmsh"):
        page += module_of(importlib.import_module(name))
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "hextwist.html").write_text("\n".join(page) + "\n</body></html>\n", encoding="utf-8")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
