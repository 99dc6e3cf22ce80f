"""Links that lead out of the book, for mdBook (0.4).

A chapter that is one `{{#include FILE}}` is that file: its text is taken, its links are read from where it lies, and a
link to the file leads to the chapter. An image from outside becomes a part of the page. Any other link out of the book
goes on to lead to the file in the repository, where the book was built in its place, `docs/book`.
"""

import base64
import json
import os
import re
import sys

if sys.argv[1:2] == ["supports"]:
    sys.exit(0)

context, book = json.load(sys.stdin)
root = os.path.dirname(os.path.abspath(context["root"]))
source = os.path.join("docs", "src")


def chapters(items):
    for item in items:
        if "Chapter" in item and item["Chapter"]["path"]:
            yield item["Chapter"]
            yield from chapters(item["Chapter"]["sub_items"])


def included(chapter):
    """The file that a chapter is, from the root of the repository."""
    only = re.fullmatch(r"\{\{#include (\S+)\}\}\s*", chapter["content"])
    return only and os.path.normpath(os.path.join(source, os.path.dirname(chapter["path"]), only[1]))


def rewritten(text, chapter, file):
    here = os.path.join(source, os.path.dirname(chapter["path"]))
    there = os.path.dirname(file) if file else here

    def link(match):
        target, anchor = match[2], match[3] or ""
        if re.match(r"[a-z]+:", target):
            return match[0]
        target = os.path.normpath(os.path.join(there, target))
        if match[1].startswith("!") and not target.startswith(source):
            with open(os.path.join(root, target), "rb") as image:
                return f"{match[1]}data:image/png;base64,{base64.b64encode(image.read()).decode()})"
        if target in names:
            target = os.path.join(source, names[target])
        elif not target.startswith(source):
            # mdBook would make `.html` of `.md`; a browser reads this as `.md`.
            target = re.sub(r"\.md$", ".%6Dd", target)
        return f"{match[1]}{os.path.relpath(target, here)}{anchor})"

    parts = re.split(r"(^```.*?^```$)", text, flags=re.MULTILINE | re.DOTALL)
    parts[::2] = [re.sub(r"(!?\[[^]]*\]\()([^)\s#]+)(#[^)\s]*)?\)", link, part) for part in parts[::2]]
    return "".join(parts)


files = {chapter["path"]: included(chapter) for chapter in chapters(book["sections"])}
names = {file: path for path, file in files.items() if file}
for chapter in chapters(book["sections"]):
    file = files[chapter["path"]]
    if file:
        with open(os.path.join(root, file), encoding="utf-8") as page:
            chapter["content"] = page.read()
    chapter["content"] = rewritten(chapter["content"], chapter, file)
json.dump(book, sys.stdout)
