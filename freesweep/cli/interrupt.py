"""Ctrl-C, SIGTERM and the end of a terminal (SIGHUP) end a command within seconds, whatever it is at.

Python tells a command of a signal between two of its own steps. The compiler, or a kernel at work on a shard, may not come
back for half a minute: then the process ends without them. Files are whole or absent at any moment, so nothing is lost.
"""

import contextlib
import os
import signal
import socket
import threading

PATIENCE = 3.5  # [s] for a command to end by itself, of the five that it may take
INTERRUPTED = 130  # exit code
ENDS = [number for name in ("SIGINT", "SIGTERM", "SIGHUP") if (number := getattr(signal, name, None))]
SENTENCE = "interrupted; files are whole or not there, and a sweep that is started again goes on from where it was"


@contextlib.contextmanager
def ends_in_time():
    """Within, SIGTERM, with which a cluster stops a job, and SIGHUP do what Ctrl-C does; each is heard of at once."""
    if threading.current_thread() is not threading.main_thread():  # to which signals belong
        yield
        return
    heard, told = socket.socketpair()
    told.setblocking(False)
    ended = threading.Event()
    watch = threading.Thread(target=_watch, args=(heard, ended), daemon=True)
    handlers = {number: signal.getsignal(number) for number in ENDS}
    for number, handler in handlers.items():
        if handler in (signal.default_int_handler, signal.SIG_DFL):  # not in what is to ignore it, as under nohup
            signal.signal(number, _interrupt)
    before = signal.set_wakeup_fd(told.fileno(), warn_on_full_buffer=False)
    watch.start()
    try:
        yield
    finally:
        ended.set()
        signal.set_wakeup_fd(before)
        for number, handler in handlers.items():
            if handler is not None:
                signal.signal(number, handler)
        told.close()
        watch.join()
        heard.close()


def _interrupt(_, frame):
    """Raise KeyboardInterrupt, but in no callback of LLVM's, which would print it and go on."""
    if frame is None or "llvmlite" not in frame.f_code.co_filename:
        raise KeyboardInterrupt


def _watch(heard, ended):
    """End the process if the command has not, some time after a signal."""
    while signals := heard.recv(1):  # nothing: closed
        if signals[0] in ENDS and not ended.wait(PATIENCE):
            line = "\n" * os.isatty(2) + SENTENCE + "\n"  # a terminal shows ^C or half a bar
            with contextlib.suppress(OSError):  # of a terminal that is gone
                os.write(2, line.encode())  # without a lock that another thread may hold
            os._exit(INTERRUPTED)
