"""Counts the lines of the package in every Python process that tests/coverage.sh starts."""

import os

if "COVERAGE_PROCESS_START" in os.environ:
    import coverage

    coverage.process_startup()
    leave = os._exit

    def save_and_leave(status):
        running = coverage.Coverage.current()
        if running is not None:
            running.stop()
            running.save()
        leave(status)

    os._exit = save_and_leave
