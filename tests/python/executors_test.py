"""Sweeps on the executors of mpi4py and of dask, as they are: the same results, and a worker that is killed on the way."""

import math
import os
import pickle
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

import catena
from four_bar import arm

try:
    import distributed
except ImportError:
    distributed = None
try:
    import mpi4py
except ImportError:
    mpi4py = None

LENGTHS = list(range(1, 9))


class MortalScene(catena.Scene):
    """Its worker is killed, as from outside, at one of the designs: as long as `alive` names a file, once."""

    fatal = 3
    alive = ""

    def run(self, parameters=None, **options):
        if parameters["length"] == self.fatal and (not self.alive or os.path.exists(self.alive)):
            if self.alive:
                os.remove(self.alive)
            os.kill(os.getpid(), signal.SIGKILL)
        return super().run(parameters, **options)

    def __getstate__(self):
        return {**super().__getstate__(), "fatal": self.fatal, "alive": self.alive}


class Checks(unittest.TestCase):
    def check(self, result, may_lack=()):
        """Every design has its result, or is among those that may be lost, and says so."""
        self.assertEqual([design["length"] for design in result.designs], LENGTHS)
        for length, x, status in zip(LENGTHS, result["x"], result.status):
            if length in may_lack and status != "ok":
                self.assertEqual(status, "lost")
                self.assertTrue(math.isnan(x))
            else:
                self.assertEqual(status, "ok")
                self.assertAlmostEqual(x, length * math.cos(0.5), 12)
        self.assertEqual([failure.number for failure in result.failures],
                         [k for k, status in enumerate(result.status) if status != "ok"])


@unittest.skipIf(distributed is None, "python3-distributed is not installed")
class Dask(Checks):
    def test_the_same_whichever_workers_die(self):
        # Processes, for threads would not die alone; no page of its own, whose packages are not needed.
        with (tempfile.TemporaryDirectory() as folder,
              distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None,
                                       silence_logs=50, local_directory=folder) as cluster,
              distributed.Client(cluster) as client, client.get_executor() as executor):
            self.check(catena.sweep(arm(), {"length": LENGTHS}, executor=executor, at_once=1))

            # A worker dies once: another gets its designs.
            once = arm(MortalScene)
            once.alive = os.path.join(folder, "alive")
            with open(once.alive, "w", encoding="utf-8"):
                pass
            self.check(catena.sweep(once, {"length": LENGTHS}, executor=executor, at_once=1, patience=120))
            self.assertFalse(os.path.exists(once.alive), "no worker died")

            # Every worker dies that gets the design: it is lost alone.
            result = catena.sweep(arm(MortalScene), {"length": LENGTHS}, executor=executor, at_once=1, patience=120)
            self.check(result, may_lack=[MortalScene.fatal])
            self.assertEqual(result.lost, [{"length": MortalScene.fatal}])
            self.assertIn("KilledWorker", result.failures[0].message)


@unittest.skipIf(mpi4py is None or shutil.which("mpirun") is None, "python3-mpi4py or mpirun is not installed")
class Mpi(Checks):
    SCRIPT = """
import pickle
import sys
import catena
from executors_test import LENGTHS, MortalScene, arm
from mpi4py import MPI
from mpi4py.futures import MPIPoolExecutor

if __name__ == "__main__":
    scene = arm(MortalScene if sys.argv[1] == "mortal" else catena.Scene)
    executor = MPIPoolExecutor()
    result = catena.sweep(scene, {"length": LENGTHS}, executor=executor, at_once=1, patience=8)
    with open(sys.argv[2], "wb") as file:
        pickle.dump(result, file)
    if result.lost:
        MPI.COMM_WORLD.Abort(7)  # a pool that lost a worker cannot be shut down
    executor.shutdown()
"""

    def run_script(self, scene, *options):
        """What `mpirun` says in the end, and the sweep if the script got that far."""
        with tempfile.TemporaryDirectory() as folder:
            script, kept = os.path.join(folder, "script.py"), os.path.join(folder, "result")
            with open(script, "w", encoding="utf-8") as file:
                file.write(self.SCRIPT)
            here = os.path.dirname(os.path.abspath(__file__))
            environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                               PYTHONPATH=os.pathsep.join([here, os.environ.get("PYTHONPATH", "")]))
            done = subprocess.run(
                ["mpirun", "--oversubscribe", *options, "-n", "3", sys.executable, "-m", "mpi4py.futures", script,
                 scene, kept],
                env=environment, capture_output=True, text=True, timeout=240, check=False)
            if not os.path.exists(kept):
                return done, None
            with open(kept, "rb") as file:
                return done, pickle.load(file)

    def test_the_same(self):
        done, result = self.run_script("immortal")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.check(result)

    def test_a_dead_worker_ends_the_job_by_default(self):
        done, result = self.run_script("mortal")
        self.assertNotEqual(done.returncode, 0)
        self.assertIsNone(result)
        self.assertIn("exited on signal 9", done.stderr)

    def test_designs_of_a_dead_worker_are_lost_where_the_job_goes_on(self):
        done, result = self.run_script("mortal", "--enable-recovery")
        self.assertIsNotNone(result, done.stderr)
        self.check(result, may_lack=[MortalScene.fatal])
        self.assertEqual(result.lost, [{"length": MortalScene.fatal}])
        self.assertIn("no answer from any worker in 8", result.failures[0].message)


if __name__ == "__main__":
    unittest.main()
