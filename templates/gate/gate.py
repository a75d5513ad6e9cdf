"""Stands between a group and those outside of it: passes calls on, as many and such as its rules allow.

Written by rcyaml from the deployment's document; it needs nothing but Python and Ice.
"""

import queue
import signal
import sys
import threading
import time

import Ice

# name, identity, endpoint, proxy of the member, calls a second (or None), methods that may be called (or None)
SERVED = ()

ALWAYS = ("ice_ping", "ice_isA", "ice_id", "ice_ids")
MOST_WAITING = 1000


class Turns(threading.Thread):
    """Lets what waits pass one by one, in its order, at equal distances."""

    def __init__(self, rate):
        super().__init__(daemon=True)
        self._distance = 1 / rate
        self._waiting = queue.Queue(MOST_WAITING)
        self.start()

    def wait(self, passed):
        """Calls `passed` when its turn has come; False where too many wait already."""
        try:
            self._waiting.put_nowait(passed)
        except queue.Full:
            return False
        return True

    def run(self):
        following = time.monotonic()
        while True:
            passed = self._waiting.get()
            now = time.monotonic()
            if following > now:
                time.sleep(following - now)
            following = max(following, now) + self._distance
            passed()


class Gate(Ice.Blobject):
    """An object of whatever interface: it does not look into the calls that it passes on."""

    def __init__(self, name, member, rate, allowed):
        self._name = name
        self._member = member
        self._turns = Turns(rate) if rate else None
        self._allowed = allowed

    def ice_invoke(self, data, current):
        name = current.operation
        if self._allowed is not None and name not in self._allowed and name not in ALWAYS:
            may = ", ".join(self._allowed) or "nothing"
            raise Ice.UnknownException("the group that serves %s allows %s, not '%s'" % (self._name, may, name))

        def call():
            return self._member.ice_invokeAsync(name, current.mode, data, current.ctx)

        if self._turns is None or name in ALWAYS:
            return call()
        answer = Ice.Future()
        if not self._turns.wait(lambda: pass_on(call, answer)):
            raise Ice.UnknownException("%d calls are already pending" % MOST_WAITING)
        return answer


def pass_on(call, answer):
    def done(future):
        try:
            answer.set_result(future.result())
        except BaseException as error:
            answer.set_exception(error)

    try:
        call().add_done_callback(done)
    except Exception as error:  # the communicator is gone, or the proxy is none
        answer.set_exception(error)


def main():
    data = Ice.InitializationData()
    data.properties = Ice.createProperties(sys.argv)
    data.properties.setProperty("Ice.MessageSizeMax", "0")
    communicator = Ice.initialize(data)
    for name in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        signal.signal(name, lambda *_: communicator.shutdown())
    try:
        for name, identity, endpoint, proxy, rate, allowed in SERVED:
            adapter = communicator.createObjectAdapterWithEndpoints(name, endpoint)
            adapter.add(Gate(name, communicator.stringToProxy(proxy), rate, allowed), Ice.stringToIdentity(identity))
            adapter.activate()
        while not communicator.isShutdown():  # a signal is only seen between two waits
            time.sleep(0.1)
    finally:
        communicator.destroy()


if __name__ == "__main__":
    main()
