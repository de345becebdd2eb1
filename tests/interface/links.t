#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Every link of the project's pages leads to a file, and to a heading in it. README.md leads to
# docs/README.md, which lists every page.
import glob
import os
import re
import sys

sys.path.insert(0, "tests")
from tap import done, ok, read


def text_of(page):
    """What is not shown as code."""
    return re.sub(r"^    .*$", "", read(page).decode(), flags=re.M)


def anchors(page):
    """Of its headings: what is no letter, figure, blank or dash goes, and blanks are dashes."""
    headings = re.findall(r"^#+ (.*)$", text_of(page), re.M)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def leads(page, link):
    """Whether a LINK of PAGE leads somewhere."""
    path, _, anchor = link.partition("#")
    target = os.path.join(os.path.dirname(page), path) if path else page
    return os.path.exists(target) and (not anchor or anchor in anchors(target))


pages = sorted(glob.glob("*.md") + glob.glob("docs/*.md"))
links = [(page, link) for page in pages for link in re.findall(r"\]\(([^)\s]+)\)", text_of(page))
         if not link.startswith("http")]
ok(len(links) > 100, "links are found", len(links))
ok(not [link for link in links if not leads(*link)], "every link leads somewhere",
   [link for link in links if not leads(*link)])
ok(("README.md", "docs/README.md") in links, "README.md leads to docs/README.md")
listed = [os.path.join("docs", link) for page, link in links if page == "docs/README.md"]
missing = [page for page in glob.glob("docs/*.md") if page not in [*listed, "docs/README.md"]]
ok(not missing, "docs/README.md lists every page", missing)
pictures = [os.path.normpath(os.path.join(os.path.dirname(page), link)) for page, link in links]
unused = [picture for picture in glob.glob("docs/pictures/*") if picture not in pictures]
ok(not unused, "every picture is shown", unused)
done()
