"""Programs of Python on several ranks, by mpirun: they print once, with the bits of one process."""

import os
import subprocess
import sys
from pathlib import Path

BZM = Path(os.environ["BOLTZMANN_BZM"])

PROGRAM = """
import hashlib
import boltzmann as bz

sim = bz.Simulation(
    units="reduced", run={"step": 0.005, "cutoff": 2.5, "steps": 40},
    box=dict(low=[0, 0], high=[48, 48], boundary="periodic"),
)
atoms = sim.ensemble("atoms", "Newton", temperature=1, load=dict(kind="block", lattice="square", spacing=1.2, counts=[40, 40]))
sim.influence("lennard-jones", on="atoms", depth=1, r0=1.12)
sim.run(25)
between = sim.measure("energies")["total energy"]
sim.run(15)
print(sim.step, hashlib.sha256(atoms.position.tobytes() + atoms.velocity.tobytes()).hexdigest(), between)
"""


def test_prints_once_with_the_bits_of_one_process():
    environment = {
        **os.environ,
        "BOLTZMANN_MPI": str(BZM.parent / "libboltzmann_mpi.so"),
        "OMP_NUM_THREADS": "1",
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    }

    def printed(*launcher):
        done = subprocess.run(
            [*launcher, sys.executable, "-c", PROGRAM], env=environment, capture_output=True, text=True, timeout=120
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    alone = printed()
    assert alone.startswith("40 ")
    for ranks in ("2", "3"):
        assert printed("mpirun", "--quiet", "--oversubscribe", "-n", ranks) == alone
