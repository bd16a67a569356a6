"""The numerical studies of Garcia-Vallejo & Schiehlen (2012), with the paper's claims beside ours.

One file for each study (`CHAPTERS` in `drakegait.paper.contents`): what is solved, what is measured
on the gaits, and the paper's claims about it, each with the rule by which it is judged.

    from drakegait.paper.contents import CHAPTERS
    from drakegait.paper.run import run

    if __name__ == "__main__":  # the workers are processes that import this file
        results = run(CHAPTERS, "out/paper")  # goes on where an earlier call was ended
        for chapter in CHAPTERS:
            for finding in results.findings(chapter):
                print(finding.verdict.value, finding.claim.what, finding.ours)
"""
