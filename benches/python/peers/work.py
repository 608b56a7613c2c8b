"""One task of one program in a process of its own, the answer as a line of JSON: what `run.py` starts.

    python work.py first|cost|drift|lines PROGRAM MECHANISM
    python work.py mistake PROGRAM MISTAKE
    python work.py setting PROGRAM
"""

import importlib
import inspect
import json
import sys
import time
import types


def program(name):
    return importlib.import_module(f"of_{name}")


def setting(name):
    return program(name).SETTING


def first(name, mechanism):
    """Seconds from before the import of the program to the state after the first step."""
    begun = time.perf_counter()
    getattr(program(name), mechanism)(1e-4).run(1)
    return time.perf_counter() - begun


def cost(name, mechanism):
    """Microseconds of the processor a step over the whole motion, the least of all runs in a second, which a processor needs to wake up."""
    from mechanisms import MECHANISMS

    asked = MECHANISMS[mechanism]
    steps, build = round(asked.end / asked.step), getattr(program(name), mechanism)
    times, begun = [], time.perf_counter()
    while time.perf_counter() < begun + 1:
        running, before = build(asked.step), time.process_time()
        running.run(steps)
        times.append(1e6 * (time.process_time() - before) / steps)
    return min(times)


def drifted(running, asked, step):
    """What the energy changes by at most, J, work of motors taken away."""
    steps = round(asked.end / step)
    samples = min(100, steps)
    energy = asked.energy(running.run(steps // samples * samples, samples))
    return float(abs(energy - energy[0]).max())


def drift(name, mechanism):
    from mechanisms import MECHANISMS

    asked = MECHANISMS[mechanism]
    return drifted(getattr(program(name), mechanism)(asked.step), asked, asked.step)


def lines(name, mechanism):
    """Lines of the function that builds it, and of the functions that it calls, which others call too; without those that are blank or explain."""
    module = program(name)
    builder = getattr(module, mechanism)
    found, left = [], [builder]
    while left:
        function = left.pop()
        found.append(function)
        called = [getattr(module, word, None) for word in function.__code__.co_names]
        left += [other for other in called if isinstance(other, types.FunctionType) and other.__module__ == module.__name__ and other not in found + left]
    count = lambda function: sum(1 for line in inspect.getsource(function).splitlines() if line.strip() and not line.strip().startswith(('"""', "#")))
    return [count(builder), sum(map(count, found[1:]))]


def mistake(name, which):
    """The words of the program about it, or what becomes of it. What it prints is read by who started this."""
    from mechanisms import MISTAKES

    module = program(name)
    try:
        if which == "a name with a slip":
            module.misspelt()
            return "taken"
        builder, asked, step = MISTAKES[which]
        running = getattr(module, builder)(step, asked)
        return f"runs; energy changes by {drifted(running, asked, step):.2g} J"
    except BaseException as error:
        return f"{type(error).__name__}: {error}"


if __name__ == "__main__":
    task, *words = sys.argv[1:]
    tasks = {task.__name__: task for task in (setting, first, cost, drift, lines, mistake)}
    print("\n" + json.dumps(tasks[task](*words)))
