"""A notebook as a page of Markdown: its cells, and what they printed when it was executed last."""

import base64
import json

OBJECTS = ("<Figure", "<IPython")  # what stands for an output that a page does not show


def joined(text):
    return text if isinstance(text, str) else "".join(text)


def fenced(text, language):
    return f"````{language}\n{text.rstrip()}\n````\n"


def output_text(output, stem, index, folder):
    """The richest form of an output that a page can show."""
    data = output.get("data", {})
    if "image/png" in data:
        name = f"{stem}-{index}.png"
        (folder / name).write_bytes(base64.b64decode(joined(data["image/png"])))
        return f"![output of the cell above]({name})\n"
    html = joined(data.get("text/html", ""))
    if html.strip() and "<script" not in html:
        return fenced(f'<div class="printed">{html}</div>', "{raw} html")
    text = joined(output.get("text") or data.get("text/plain", ""))
    return "" if text.startswith(OBJECTS) or not text.strip() else fenced(text, "text")


def page(notebook, folder):
    """The page of a notebook; its pictures are written to the folder."""
    parts = []
    for index, cell in enumerate(json.loads(notebook.read_text(encoding="utf-8"))["cells"]):
        source = joined(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(source + "\n")
        elif source.strip():
            parts.append(fenced(source, "python"))
            outputs = (output_text(output, notebook.stem, f"{index}-{number}", folder) for number, output in enumerate(cell["outputs"]))
            parts.extend(filter(None, outputs))
    return "\n".join(parts)
