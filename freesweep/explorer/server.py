"""Serves the page of one atlas to this machine alone: bound to 127.0.0.1, and deaf to pages of others."""

import contextlib
import json
import secrets
import sys
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

from ..atlas.files import EnvironmentFault
from .compiling import Compiling
from .desk import Desk
from .exact import shape, solved
from .page import page_of
from .polish import polished
from .wire import pack

HOST = "127.0.0.1"
LARGEST = 1 << 20  # [bytes] of a question


class Explorer(ThreadingHTTPServer):
    """The server of one atlas; ``url`` is where it is. Used as a context manager, it ends with the block."""

    daemon_threads = True

    def __init__(self, atlas, port=0):
        self.desk, self.token = Desk(atlas), secrets.token_urlsafe(18)
        self.page = page_of(self.desk, token=self.token).encode()
        try:
            super().__init__((HOST, port), _Handler)
        except OSError as error:
            raise EnvironmentFault(
                f"port {port} of {HOST}: {error.strerror}; give another, or none: any free one"
            ) from error
        self._thread, self._compiling = None, Compiling()

    @property
    def url(self) -> str:
        """Address of the page."""
        return f"http://{HOST}:{self.server_address[1]}/"

    def ask(self, question: dict) -> dict:
        """The answer to one question of the page. Raises ValueError."""
        slow = {"shape": shape, "exact": solved, "polish": polished}
        what = question.get("what") if isinstance(question, dict) else None
        if what == "busy":
            return {"compiling": self._compiling.seconds}
        return slow[what](self.desk, question) if what in slow else self.desk.answer(question)

    def start(self):
        """Serve from a thread of its own; returns itself."""
        self._thread = threading.Thread(target=self.serve_forever, kwargs={"poll_interval": 0.1}, daemon=True)
        self._thread.start()
        threading.Thread(target=self.desk.begin, daemon=True).start()  # while the browser opens
        return self

    def wait(self):
        """Serve until Ctrl-C, which is how one ends it."""
        with contextlib.suppress(KeyboardInterrupt):
            self._thread.join()

    def stop(self):
        """End it."""
        if self._thread is not None:
            self.shutdown()
            self._thread = None
            self._compiling.close()
        self.server_close()

    def handle_error(self, request, client_address):
        """Nothing is said of a page that was closed before its answer came."""
        if not isinstance(sys.exception(), ConnectionError):
            super().handle_error(request, client_address)

    def __exit__(self, *_):
        self.stop()

    def _repr_html_(self):
        return f'<iframe src="{self.url}" style="width:100%;height:760px;border:0" title="freesweep explorer"></iframe>'

    def __repr__(self):
        return f"<Explorer of {self.desk.atlas.path.name} at {self.url}>"


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True

    def _is_ours(self):
        """Whether the browser means this server: a name that a stranger's site points here is refused."""
        own = {f"{HOST}:{self.server.server_address[1]}", f"localhost:{self.server.server_address[1]}"}
        return self.headers.get("Host") in own

    def do_GET(self):
        if not self._is_ours() or self.path.partition("?")[0] != "/":
            self._send(404, b"nothing here", "text/plain")
            return
        self._send(200, self.server.page, "text/html; charset=utf-8")

    def do_POST(self):
        size = self.headers.get("Content-Length", "")
        known = secrets.compare_digest(self.headers.get("X-Freesweep", ""), self.server.token)
        if not (self._is_ours() and known and self.path == "/ask" and size.isdigit() and int(size) <= LARGEST):
            self.close_connection = True
            self._send(403, b"refused", "text/plain")
            return
        try:
            question = json.loads(self.rfile.read(int(size)))
            content = pack(self.server.ask(question))
        except (ValueError, RecursionError) as error:
            self._send(400, str(error).encode(), "text/plain; charset=utf-8")
        except Exception as error:  # the page says it, the terminal shows where
            self._send(500, f"{type(error).__name__}: {error}".encode(), "text/plain; charset=utf-8")
            raise
        else:
            self._send(200, content, "application/octet-stream")

    def _send(self, code, content, kind):
        self.send_response(code)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Cache-Control", "no-store")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, *_):
        pass
