"""Connections that send or take too little, and too many of them. Time is the test's own: no limit is waited for."""

from __future__ import annotations

import asyncio
import errno
import resource
import socket
from contextlib import ExitStack, suppress
from unittest.mock import Mock

import pytest
import uvicorn
from uvicorn.server import ServerState

from pneutouch.studio.server import Connection, most_connections, without_traceback
from tests.studio.raw import answer, request, status
from tests.studio.served import Studio, served

HEAD = b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 4\r\n\r\n"


class Timer:
    """A call that is due after some seconds, until it is cancelled."""

    def __init__(self, seconds, call):
        self.seconds, self.call, self.runs = seconds, call, True

    def cancel(self):
        self.runs = False


class Loop:
    """A loop whose time stands unless the test moves it; it keeps what is due and begins nothing."""

    def __init__(self):
        self.now, self.timers = 0.0, []

    def time(self):
        self.now += 1
        return self.now

    def call_later(self, seconds, call, *words):
        self.timers.append(Timer(seconds, call))
        return self.timers[-1]

    def create_task(self, work, **more):
        work.close()
        return Mock()

    def due(self):
        return [timer for timer in self.timers if timer.runs]


class Wire(asyncio.Transport):
    """A transport that keeps what is written."""

    def __init__(self):
        super().__init__()
        self.written, self.closed, self.aborted = b"", False, False

    def write(self, data):
        self.written += data

    def is_closing(self):
        return self.closed or self.aborted

    def close(self):
        self.closed = True

    def abort(self):
        self.aborted = True

    def pause_reading(self):
        pass

    def resume_reading(self):
        pass


@pytest.fixture
def connect():
    """Opens connections to one server that nobody runs: ``connection, wire``."""
    loop, state = Loop(), ServerState()

    async def answered(scope, receive, send):
        """Nothing: the tests complete the answers."""

    config = uvicorn.Config(answered, log_config=None, ws="none")
    config.load()

    def opened():
        connection, wire = Connection(config, state, {}, loop), Wire()
        connection.connection_made(wire)
        return connection, wire

    opened.loop = loop
    return opened


def complete(connection):
    """Send the whole answer to the request that the connection has."""

    async def send():
        await connection.cycle.send({"type": "http.response.start", "status": 204, "headers": []})
        await connection.cycle.send({"type": "http.response.body"})

    asyncio.run(send())


@pytest.mark.parametrize("sent", [b"", b"POST / HT", HEAD, HEAD + b"123"])
def test_a_request_that_does_not_come_to_its_end_is_given_up(sent, connect):
    connection, wire = connect()
    for byte in sent:
        connection.data_received(bytes([byte]))
    (timer,) = connect.loop.due()
    timer.call()
    assert wire.aborted


def test_bytes_that_come_slowly_do_not_begin_a_limit_again(connect):
    connection, _ = connect()
    (head,) = connect.loop.due()
    for byte in HEAD[:-1]:
        connection.data_received(bytes([byte]))
        assert connect.loop.due() == [head]
    connection.data_received(HEAD[-1:])
    (body,) = connect.loop.due()
    connection.data_received(b"1")
    connection.data_received(b"2")
    assert connect.loop.due() == [body]
    assert not head.runs


def test_an_answer_has_no_limit_and_what_comes_after_it_has(connect):
    connection, wire = connect()
    connection.data_received(HEAD + b"1234")
    assert connect.loop.due() == []
    complete(connection)
    idle = connect.loop.due()
    assert len(idle) == 2
    # Half a head ends the server's own limit on silence, and not this one.
    connection.data_received(b"GET")
    (timer,) = connect.loop.due()
    timer.call()
    assert wire.aborted


def test_an_answer_that_is_not_taken_is_given_up(connect):
    connection, wire = connect()
    connection.data_received(HEAD + b"1234")
    connection.pause_writing()
    (timer,) = connect.loop.due()
    connection.resume_writing()
    assert connect.loop.due() == []
    connection.pause_writing()
    (timer,) = connect.loop.due()
    timer.call()
    assert wire.aborted


def test_a_connection_that_ended_has_no_limit(connect):
    connection, _ = connect()
    connection.connection_lost(None)
    assert connect.loop.due() == []


def test_one_too_many_closes_the_one_that_waited_longest(connect, monkeypatch):
    monkeypatch.setattr(Connection, "most", 3)
    busy, first, second = connect(), connect(), connect()
    busy[0].data_received(HEAD + b"1234")
    third, fourth = connect(), connect()
    assert [wire.aborted for _, wire in (busy, first, second, third, fourth)] == [False, True, True, False, False]


def test_one_too_many_is_closed_where_every_other_is_being_answered(connect, monkeypatch):
    monkeypatch.setattr(Connection, "most", 2)
    busy = [connect(), connect()]
    for connection, _ in busy:
        connection.data_received(HEAD + b"1234")
    _, last = connect()
    assert last.aborted
    assert not any(wire.aborted for _, wire in busy)


def test_connections_leave_files_for_the_jobs():
    assert most_connections(64) == 16
    assert most_connections(1024) == most_connections(1 << 20) == most_connections(resource.RLIM_INFINITY)


def test_a_lack_of_files_is_not_written_on_the_terminal(caplog):
    loop = asyncio.new_event_loop()
    try:
        without_traceback(loop, {"message": "accept", "exception": OSError(errno.EMFILE, "too many")})
        loop.set_exception_handler(without_traceback)
        loop.call_soon(Mock(side_effect=OSError(errno.EMFILE, "too many")))
        with socket.socket() as listener:
            pass
        loop.call_soon(loop._start_serving, None, listener)
        loop.call_soon(loop.stop)
        loop.run_forever()
        assert caplog.records == []
        without_traceback(loop, {"message": "ours", "exception": ValueError("ours")})
        assert len(caplog.records) == 1
    finally:
        loop.close()


def test_more_connections_than_files_keep_nobody_out_and_write_nothing():
    with served(files=64) as (address, process), ExitStack() as open_ones:
        studio = Studio(address, process)
        for _ in range(200):
            each = open_ones.enter_context(socket.create_connection(("127.0.0.1", studio.port), timeout=60))
            # It may have been closed for those before it.
            with suppress(ConnectionError):
                each.sendall(b"POST /api/quick HTTP/1.1\r\nHost: ")
        assert status(answer(studio, request(studio))) == 200
        process.terminate()
        said = process.communicate(timeout=60)[1]
    assert "Traceback" not in said
    assert "accept" not in said
