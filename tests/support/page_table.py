"""The tables of a page that scripts write."""


def parts_around(page, script):
    """The page up to the table of this script, the table, and what follows it."""
    text = page.read_text(encoding="utf-8")
    before, opening, rest = text.partition(f"<!-- {script}: written by ")
    first_line, _, rest = rest.partition("\n")
    table, closing, after = rest.partition(f"<!-- end of {script} -->")
    if not opening or not closing:
        raise SystemExit(f"{page}: no table of {script}")
    return before + opening + first_line + "\n", table, closing + after


def table_in(page, script):
    """The table between "<!-- SCRIPT: written by … -->" and "<!-- end of SCRIPT -->" of `page` (a path)."""
    return parts_around(page, script)[1]


def replace_table(page, script, table):
    """Puts `table` in that place."""
    before, _, after = parts_around(page, script)
    page.write_text(before + table + after, encoding="utf-8")
