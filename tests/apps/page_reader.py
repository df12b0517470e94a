# SPDX-License-Identifier: Apache-2.0
"""What a page of HTML holds, read by Python's own parser."""
import html.parser


class Page(html.parser.HTMLParser):
    """ids, links and tags of a page; text by the id of its section."""

    def __init__(self, text):
        super().__init__()
        self.ids, self.links, self.tags, self.open, self.sections = [], [], [], [], {}
        self.feed(text)
        assert not self.open, self.open

    def handle_starttag(self, tag, attributes):
        known = dict(attributes)
        self.tags.append(tag)
        self.ids += [known["id"]] if "id" in known else []
        self.links += [known[name] for name in ("src", "href", "data", "action", "srcset") if name in known]
        if tag == "section":
            self.open.append(known.get("id", ""))

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)

    def handle_endtag(self, tag):
        if tag == "section":
            self.open.pop()

    def handle_data(self, text):
        if self.open:
            self.sections[self.open[-1]] = self.sections.get(self.open[-1], "") + text
