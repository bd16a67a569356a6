"""Where the published numbers are from."""

from __future__ import annotations

SOURCES = {
    "Winter 1991": "D. A. Winter, The Biomechanics and Motor Control of Human Gait, 2nd ed. "
    "(1991): mean pattern of adults at natural cadence, 1.325 m/s. Curves as distributed with the "
    "BioMAC-Sim-Toolbox; peaks of moments as usually quoted, rounded.",
    "one adult": "One adult of 62 kg at 1.33 m/s, measured for A. Falisse et al., Rapid predictive "
    "simulations with complex musculoskeletal models suggest that diverse healthy and pathological "
    "human gaits can emerge from similar control strategies, J. R. Soc. Interface 16 (2019).",
    "textbooks": "Rounded values of textbooks of gait analysis, as in J. Perry, Gait Analysis: "
    "Normal and Pathological Function (1992), and Winter 1991.",
    "Browning 2007": "R. C. Browning, J. R. Modica, R. Kram, A. Goswami, The effects of adding "
    "mass to the legs on the energetics and biomechanics of walking, Med. Sci. Sports Exerc. 39 "
    "(2007): five men at 1.25 m/s, net metabolic rate.",
    "McGinley 2009": "J. L. McGinley, R. Baker, R. Wolfe, M. E. Morris, The reliability of "
    "three-dimensional kinematic gait measurements: a systematic review, Gait & Posture 29 (2009).",
}
"""Name in the tables -> citation."""
