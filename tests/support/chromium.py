"""Headless Chromium, driven through its DevTools protocol."""

from __future__ import annotations

import asyncio
import atexit
import base64
import functools
import json
import os
import shutil
import signal
import subprocess
import tempfile
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self

import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from tests.support.waiting import until

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from websockets.asyncio.client import ClientConnection

CHROMIUM: Final = next(
    (
        path
        for name in ("chromium", "chromium-browser", "google-chrome")
        if (path := shutil.which(name))
    ),
    None,
)
IN_A_BROWSER: Final = [
    pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed"),
    pytest.mark.one_loop,
]
"""The marks of tests with a browser."""

OPTIONS: Final = (
    "--headless=new",
    "--no-sandbox",  # which does not work for root
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-extensions",
    "--disable-sync",
    "--no-first-run",
    "--in-process-gpu",  # one process less for each browser
    # Chromium starts a process for the page after the next one, for every context.
    "--disable-features=SpareRendererForSitePerProcess,MediaRouter,OptimizationHints,Translate",
    "--remote-debugging-port=0",
)


class Page:
    """One tab."""

    def __init__(self, browser: Browser, target: str, session: str) -> None:
        self._browser = browser
        self._target = target
        self._session = session

    async def do(self, method: str, **parameters: Any) -> Any:
        """Call a method of the DevTools protocol, and return its result."""
        return await self._browser.do(method, session=self._session, **parameters)

    async def value(self, expression: str) -> Any:
        """Return the value of an expression of JavaScript; a promise is awaited."""
        answer = await self.do(
            "Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True
        )
        if "exceptionDetails" in answer:
            raise AssertionError(f"{expression}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    async def until(self, expression: str, patience_sec: float = 20.0) -> Any:
        """Wait until an expression is true, and return its value."""
        looking = (
            "new Promise(done => { const look = () => { let found;"
            f"try {{ found = {expression}; }} catch {{}}"
            "found ? done(found) : setTimeout(look, 20); }; look(); })"
        )
        try:
            async with asyncio.timeout(patience_sec):
                return await self.value(looking)
        except TimeoutError:
            text = await self.value("document.body?.innerText")
            raise AssertionError(f"not true for {patience_sec:g} s: {expression}\n{text}") from None

    async def text(self, selector: str) -> str:
        """Return the text of an element."""
        return str(await self.value(f"document.querySelector({selector!r}).textContent"))

    async def place(self, selector: str) -> tuple[float, float]:
        """Return where the middle of an element is, scrolled into view."""
        box = await self.until(
            f"(() => {{ const e = document.querySelector({selector!r});"
            "e.scrollIntoView({block: 'center'}); const b = e.getBoundingClientRect();"
            "return [b.x + b.width / 2, b.y + b.height / 2]; })()"
        )
        return box[0], box[1]

    async def mouse(self, kind: str, x: float, y: float) -> None:
        """Send an event of the left button: mousePressed, mouseMoved or mouseReleased."""
        await self.do(
            "Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1, buttons=1
        )

    async def click(self, selector: str) -> None:
        """Click on the middle of an element."""
        x, y = await self.place(selector)
        await self.mouse("mousePressed", x, y)
        await self.mouse("mouseReleased", x, y)

    async def choose(self, selector: str, value: str) -> None:
        """Choose a value of a select element, once it has it."""
        found = f"document.querySelector({selector!r})"
        await self.until(f"[...{found}.options].some(option => option.value === {value!r})")
        await self.value(
            f"{found}.value = {value!r}; {found}.dispatchEvent(new Event('change')); 1"
        )

    async def write(self, selector: str, text: str) -> None:
        """Replace the text of a field."""
        found = f"document.querySelector({selector!r})"
        await self.value(f"{found}.value = {text!r}; {found}.dispatchEvent(new Event('change')); 1")

    async def screenshot(self, path: Path, selector: str | None = None) -> None:
        """Save a screenshot of the page, or of one element."""
        clip: dict[str, Any] = {}
        if selector:
            box = await self.value(
                f"(b => ({{x: b.x + scrollX, y: b.y + scrollY, width: b.width, height: b.height}}))"
                f"(document.querySelector({selector!r}).getBoundingClientRect())"
            )
            clip = {"clip": {**box, "scale": 1}, "captureBeyondViewport": True}
        answer = await self.do("Page.captureScreenshot", format="png", **clip)
        path.write_bytes(base64.b64decode(answer["data"]))

    async def hide(self) -> None:
        """Open another tab before this one, as a user does."""
        await self._browser.open("about:blank")
        await self.until("document.hidden")

    async def close(self) -> None:
        """Close the tab, as a user does."""
        await self._browser.do("Target.closeTarget", targetId=self._target)


class Browser:
    """A running Chromium."""

    def __init__(self, connection: ClientConnection) -> None:
        self._connection = connection
        self._answers: dict[int, asyncio.Future[Any]] = {}
        self._last_id = 0
        self._context = ""

    async def begin(self) -> Self:
        """Create a separate browser context, which is discarded with the connection."""
        made = await self.do("Target.createBrowserContext", disposeOnDetach=True)
        self._context = made["browserContextId"]
        return self

    async def do(self, method: str, session: str | None = None, **parameters: Any) -> Any:
        """Call a method of the DevTools protocol, and return its result."""
        self._last_id += 1
        answer = self._answers[self._last_id] = asyncio.get_running_loop().create_future()
        call = {"id": self._last_id, "method": method, "params": parameters}
        await self._connection.send(json.dumps(call | ({"sessionId": session} if session else {})))
        return await answer

    async def read(self) -> None:
        """Pass answers to their callers until the connection ends."""
        with suppress(ConnectionClosed):
            async for text in self._connection:
                message = json.loads(text)
                answer = self._answers.pop(message.get("id", 0), None)
                if answer is None or answer.done():
                    continue
                if "error" in message:
                    answer.set_exception(AssertionError(message["error"]["message"]))
                else:
                    answer.set_result(message["result"])

    async def open(self, url: str, *, width: int = 1280, height: int = 900) -> Page:
        """Open a page in a new tab."""
        tab = {"url": "about:blank", "browserContextId": self._context}
        target = (await self.do("Target.createTarget", **tab))["targetId"]
        attached = await self.do("Target.attachToTarget", targetId=target, flatten=True)
        page = Page(self, target, attached["sessionId"])
        await page.do(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )
        await page.do("Page.navigate", url=url)
        return page


class Process:
    """A Chromium shared by the tests of this process, as its start takes longer than most tests."""

    def __init__(self) -> None:
        assert CHROMIUM is not None
        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self._address = Path(self._profile.name, "DevToolsActivePort")
        self._process = subprocess.Popen(
            [CHROMIUM, *OPTIONS, f"--user-data-dir={self._profile.name}"],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env=os.environ | {"HOME": self._profile.name},
            start_new_session=True,
        )
        atexit.register(self.end)

    async def address(self) -> str:
        """Wait until it listens, and return the address."""
        async with asyncio.timeout(20):
            await until(lambda: self._address.is_file() and "/" in self._address.read_text())
        port, path = self._address.read_text().split()
        return f"ws://127.0.0.1:{port}{path}"

    def end(self) -> None:
        """Kill it and all its processes."""
        with suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        self._profile.cleanup()


@functools.cache
def process() -> Process:
    """Return the running Chromium."""
    return Process()


@asynccontextmanager
async def chromium() -> AsyncIterator[Browser]:
    """Yield a browser with its own cookies, caches and tabs, which end with the block."""
    address = await process().address()
    async with (
        connect(address, max_size=None, proxy=None) as connection,
        asyncio.TaskGroup() as tasks,
    ):
        browser = Browser(connection)
        reading = tasks.create_task(browser.read())
        yield await browser.begin()
        reading.cancel()  # the tabs are closed with the connection
