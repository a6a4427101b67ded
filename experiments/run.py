"""Run experiments of the paper: ``python experiments/run.py [figure2 figure6 …] --data DIR -o OUT``."""

from experiment import main
from figure2 import figure2
from figure3 import figure3
from figure4 import figure4
from figure5 import figure5
from figure6 import figure6
from figure7 import figure7
from formulations import formulations
from section44 import section44

EXPERIMENTS = (figure2, figure3, figure4, figure5, figure6, figure7, section44, formulations)

if __name__ == "__main__":
    main(*EXPERIMENTS)
