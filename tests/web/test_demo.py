#!/usr/bin/python3
"""The demo's page in windows of several sizes. Made by tests/e2e/demo_page.sh: test_demo.py FOLDER."""
import sys
import unittest

from browser import Browser, Server

FOLDER = sys.argv[1]

# What reaches over the window's right border, but for what scrolls in a box that does not.
WIDE = """
return [...document.querySelectorAll("body *")].filter(e => {
    for (let box = e.parentElement; box !== document.body; box = box.parentElement)
        if (getComputedStyle(box).overflowX !== "visible")
            return false;
    return e.getBoundingClientRect().right > innerWidth + 0.5;
}).map(e => `${e.tagName} ${e.className} ${e.textContent.slice(0, 40)}`);
"""


class Demo(unittest.TestCase):
    def test_nothing_is_wider_than_the_window(self):
        server, browser = Server(FOLDER), Browser(390, 844)
        self.addCleanup(server.close)
        self.addCleanup(browser.close)
        browser.driver.get(server.address + "/index.html")
        self.assertGreater(browser.js("return document.querySelectorAll('#stages tr').length"), 1)
        for width in (390, 320, 768, 1440):
            browser.resize(width, 844)
            browser.wait(f"return innerWidth === {width}")
            self.assertEqual(browser.js(WIDE), [], width)
            self.assertLessEqual(browser.js("return document.documentElement.scrollWidth"), width)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:], verbosity=2)
