"""The tables of a page that scripts write."""


def replace_table(page, script, table):
    """Puts `table` between "<!-- SCRIPT: written by … -->" and "<!-- end of SCRIPT -->" of `page` (a path)."""
    text = page.read_text(encoding="utf-8")
    before, opening, rest = text.partition(f"<!-- {script}: written by ")
    first_line, _, rest = rest.partition("\n")
    _, closing, after = rest.partition(f"<!-- end of {script} -->")
    if not opening or not closing:
        raise SystemExit(f"{page}: no table of {script}")
    page.write_text(before + opening + first_line + "\n" + table + closing + after, encoding="utf-8")
