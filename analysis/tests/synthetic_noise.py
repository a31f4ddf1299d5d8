"""Times with a known truth, noisy like those of a shared virtual machine."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Noise:
    """Relative noise of a shared two-CPU virtual machine: from process to process, from repetition to
    repetition, bursts of other tenants' work on single repetitions, and slow drift over the blocks.
    """

    process: float = 0.007
    repetition: float = 0.01
    burst_rate: float = 0.03
    burst_size: float = 0.3
    drift: float = 0.05

    def seconds(self, generator: np.random.Generator, truth: Floats, blocks: int, repetitions: int) -> Floats:
        """Return samples around the true times, as configurations x blocks x repetitions."""
        shape = (len(truth), blocks, repetitions)
        steps = generator.normal(0, self.drift / np.sqrt(blocks), blocks)
        drift = np.cumsum(steps) + self.drift * np.sin(np.arange(blocks) / 3)
        process = generator.normal(0, self.process, shape[:2])
        repetition = generator.normal(0, self.repetition, shape)
        burst = generator.uniform(0, np.log1p(self.burst_size), shape) * (
            generator.random(shape) < self.burst_rate
        )
        logs: Floats = drift[:, None] + process[..., None] + repetition + burst
        result: Floats = truth[:, None, None] * np.exp(logs)
        return result


QUIET = Noise(process=0.002, repetition=0.002, burst_rate=0, drift=0.01)


def times_table(
    truth: dict[str, float], blocks: int, repetitions: int, noise: Noise, seed: int
) -> pd.DataFrame:
    """Return the columns of the table `times` that the statistics use, one series a key of `truth`."""
    return of_processes(samples_table(truth, blocks, repetitions, noise, seed))


def of_processes(samples: pd.DataFrame) -> pd.DataFrame:
    """Return a row a process of a table of repetitions, as the table `times` has them."""
    runs = samples.groupby("file", sort=False)["steps_seconds"].agg(np.array)
    first = samples.drop_duplicates("file").set_index("file")
    return first.assign(steps_seconds=runs.map(np.median), steps_seconds_of_runs=runs).reset_index()


def samples_table(
    truth: dict[str, float], blocks: int, repetitions: int, noise: Noise, seed: int
) -> pd.DataFrame:
    """Return the same, a row a repetition."""
    generator = np.random.default_rng(seed)
    samples = noise.seconds(generator, np.array(list(truth.values())), blocks, repetitions)
    series, block, repetition = (axis.ravel() for axis in np.indices(samples.shape))
    names = np.array(list(truth))[series]
    return pd.DataFrame(
        {
            "file": [f"{name}-{number}" for name, number in zip(names, block, strict=True)],
            "experiment": "synthetic",
            "series": names,
            "x": 0.0,
            "label": None,
            "replicate": 1,
            "scene_name": None,
            "node": "node",
            "session": "session",
            "block": block,
            "repetition": repetition,
            "steps_seconds": samples.ravel(),
        }
    )
