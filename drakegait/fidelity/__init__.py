"""The model held against walking people: published numbers beside ours, misses included.

One file for each section (`SECTIONS` in `drakegait.fidelity.contents`): what is solved, what is
measured on the gaits, and what was published, each with the rule by which ours is called inside or
outside. Solving, files and numbers are those of `drakegait.paper`.

    from drakegait.fidelity.contents import SECTIONS
    from drakegait.paper.run import run

    if __name__ == "__main__":  # the workers are processes that import this file
        results = run(SECTIONS, "out/fidelity")  # goes on where an earlier call was ended
        for section in SECTIONS:
            for row in section.judged(results):
                print(row.place.value, row.quantity, row.ours)
"""
