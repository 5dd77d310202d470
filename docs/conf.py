"""How scripts/docs makes a web site of README.md, CONTRIBUTING.md and this folder.

The source folder is the repository's root, so that every relative link is the one that works on GitHub, too.
"""

import os
import re
import shutil
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from public_headers import PublicHeaders  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

project = "flexarm"
author = "flexarm maintainers"
root_doc = "README"
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = [
    entry for entry in os.listdir(ROOT) if entry not in ("README.md", "CONTRIBUTING.md", "docs")
]
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax", "breathe"]

html_theme = "furo"
html_title = "flexarm"
html_static_path = ["site.css", "site.js"]
html_css_files, html_js_files = ["site.css"], ["site.js"]
html_show_copyright = html_copy_source = False
pygments_style = "friendly"

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
myst_dmath_double_inline = True
suppress_warnings = ["myst.header"]  # pages that begin with a heading of the second level
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_CHTML"
mathjax2_config = {"tex2jax": {"processClass": "math", "ignoreClass": "tex2jax_ignore"}}
myst_update_mathjax = False  # for the third version, which Debian does not have

MATHJAX_PARTS = ["MathJax.js", "config/TeX-AMS_CHTML.js", "extensions", "jax/element", "jax/input/TeX",
                 "jax/output/CommonHTML", "fonts/HTML-CSS/TeX/woff"]

autodoc_member_order = "bysource"
autodoc_typehints = "none"

DOXYGEN_XML = os.path.join(os.environ["FLEXARM_DOCS"], "doxygen", "xml")
breathe_projects = {"flexarm": DOXYGEN_XML}
breathe_default_project = "flexarm"

# The pages that `flexarm bench validation` writes, one for each case.
VALIDATION = sorted(name[:-3] for name in os.listdir(os.path.join(ROOT, "docs", "validation"))
                    if name.endswith(".md") and name != "README.md")

# The order of reading: each page has a next one. A caption of README.md or a page, then what is below it.
CONTENTS = {
    "README": [
        ("Use", """docs/install docs/guide docs/tutorial_flexible_link docs/tutorial_servo docs/from_gazebo
            docs/tutorial_ros docs/tutorial_moveit docs/tutorial_pick
            docs/ros_control docs/tutorial_modes docs/tutorial_library docs/tune docs/sweep
            docs/payloads docs/identify docs/linearise docs/show docs/results docs/plot docs/film docs/portability"""),
        ("Reference", """docs/scene_format docs/ros docs/rviz docs/web docs/troubleshooting docs/command_line
            docs/python docs/python_api docs/cpp_api docs/schemes"""),
        ("Theory", "docs/theory docs/notes/README docs/architecture CONTRIBUTING"),
        ("Reports", """docs/demo docs/contact docs/lines docs/reports/speed docs/reports/accuracy docs/reports/hard
            docs/reports/properties docs/reports/thesis docs/reports/scaling docs/reports/latency docs/reports/soak
            docs/reports/faults docs/validation/README"""),
    ],
    "docs/scene_format": [
        ("", """scene/conventions scene/parameters scene/links scene/joints scene/loops scene/cylinders scene/play
            scene/drives scene/simulation scene/springs scene/tendons scene/contact scene/sensors
            scene/functions_of_time scene/checks"""),
    ],
    "docs/validation/README": [("", " ".join(VALIDATION))],
    "docs/theory": [("", "theory/beams theory/joints theory/time_integration theory/statics_and_modes")],
    "docs/notes/README": [
        ("", """beam joints refinement beyond viscoelastic explicit newton tree planar kernel stops drives lines oil
            contact linearisation sensitivities accuracy tuning page"""),
    ],
}


def toctree(caption, pages):
    lines = ["", "", "```{toctree}", ":hidden:"] + ([":caption: " + caption] if caption else []) + [""]
    return "\n".join(lines + pages.split() + ["```", ""])


def prepare_page(app, name, source):
    """GitHub's way to write formulas; no links to folders of the repository, which the site has not; the contents."""
    text = source[0]
    if name == "docs/cpp_api":
        source[0] = show_headers(text)
        return
    folder = os.path.dirname(os.path.join(ROOT, name))

    def without_link(match):
        return match[1] if os.path.isdir(os.path.join(folder, match[2])) else match[0]

    text = text.replace("```math", "```{math}")
    text = re.sub(r"\$`([^`]+)`\$", r"$\1$", text)
    text = re.sub(r"\[([^][]*)\]\(([^)#:]+)\)", without_link, text)
    source[0] = text + "".join(toctree(*tree) for tree in CONTENTS.get(name, []))


def write_xml(app):
    """The public headers, for breathe."""
    os.makedirs(os.path.dirname(DOXYGEN_XML), exist_ok=True)
    with open(os.path.join(ROOT, "docs", "Doxyfile"), encoding="utf-8") as file:
        settings = file.read()
    settings += "INPUT = include\nSTRIP_FROM_PATH = include\nGENERATE_HTML = NO\nGENERATE_XML = YES\n"
    settings += "OUTPUT_DIRECTORY = %s\n" % os.path.dirname(DOXYGEN_XML)
    subprocess.run(["doxygen", "-"], input=settings, text=True, cwd=ROOT, check=True)


def show_headers(text):
    """Puts the contents of each header below its name, and sees to it that none is missing."""
    headers = PublicHeaders(DOXYGEN_XML)
    names = re.findall(r"^flexarm/\S+\.h$", text, re.MULTILINE)
    if missing := headers.files() - set(names):
        raise LookupError("docs/cpp_api.rst does not name %s" % ", ".join(sorted(missing)))
    for name in names:
        title = "%s\n%s\n" % (name, "~" * len(name))
        text = text.replace(title, title + "\n" + headers.directives(name))
    return text


def mark_up(app, kind, name, thing, options, lines):
    """The module's docstrings are plain text: paragraphs, arguments as "name: ...", and code that is indented."""
    text = []
    in_code = False
    for line in lines:
        argument = re.match(r"\s*([a-z_]+(?:, [a-z_]+)*): (.*)", line)
        starts = not text or not text[-1].strip()
        in_code = in_code and (line.startswith("    ") or not line.strip())
        if starts and line.startswith("    ") and not argument and not in_code:
            in_code = True
            text += ["::", ""]
        if in_code:
            text.append(line)
        elif argument:
            text += ["", "- **%s**: %s" % (argument[1], escaped(argument[2])), ""]
        elif line.startswith("  ") and len(text) > 1 and text[-2].startswith("- **"):
            text[-2] += " " + escaped(line.strip())
        else:
            text.append(escaped(line.strip()))
    lines[:] = text


def escaped(text):
    """For reStructuredText, which knows `names` by two backticks."""
    parts = text.split("`")
    if len(parts) % 2 == 0:
        parts = ["`".join(parts)]
    parts[::2] = [re.sub(r"([\\*|`_])", r"\\\1", part) for part in parts[::2]]
    return "``".join(parts)


def copy_mathjax(app, exception):
    """What the pages need of Debian's copy, so that formulas need no network."""
    source, target = "/usr/share/javascript/mathjax", os.path.join(app.outdir, "_static", "mathjax")
    for part in MATHJAX_PARTS:
        copy = shutil.copytree if os.path.isdir(os.path.join(source, part)) else shutil.copy
        os.makedirs(os.path.dirname(os.path.join(target, part)), exist_ok=True)
        options = {"dirs_exist_ok": True} if copy is shutil.copytree else {}
        copy(os.path.join(source, part), os.path.join(target, part), **options)


def setup(app):
    app.connect("build-finished", copy_mathjax)
    app.connect("builder-inited", write_xml)
    app.connect("source-read", prepare_page)
    app.connect("autodoc-process-docstring", mark_up)
