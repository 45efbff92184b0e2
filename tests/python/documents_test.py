"""What documents say is true: types, examples in the package, the tutorial of the manual."""

import doctest
import importlib
import importlib.util
import os
import pathlib
import pkgutil
import re
import subprocess
import sys
import tempfile
import unittest

import catena

HERE = pathlib.Path(__file__).parent
PACKAGE = pathlib.Path(catena.__file__).parent
ROOT = HERE.parent.parent


class Types(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not importlib.util.find_spec("mypy"):
            raise unittest.SkipTest("mypy is not installed")
        cls.cache = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.cache.cleanup)

    def run_mypy(self, module, *arguments):
        environment = {**os.environ, "MYPYPATH": str(PACKAGE.parent), "MYPY_CACHE_DIR": self.cache.name}
        return subprocess.run([sys.executable, "-m", module, *arguments], cwd=self.cache.name, env=environment,
                              capture_output=True, text=True)

    def test_of_the_package_are_sound(self):
        done = self.run_mypy("mypy", "--config-file", str(HERE / "mypy.ini"), "-p", "catena")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_of_the_stubs_are_those_of_the_module(self):
        done = self.run_mypy(
            "mypy.stubtest", "catena._catena", "catena.elements", "--mypy-config-file", str(HERE / "mypy.ini"),
            "--allowlist", str(HERE / "stubtest_allowed.txt"),
        )
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_of_elements_are_checked_where_they_are_used(self):
        with tempfile.NamedTemporaryFile("w", suffix=".py") as file:
            file.write('import catena\ncatena.Revolute(i="ground", j="a")\ncatena.Revolute(i="ground", k="a")\n')
            file.flush()
            done = self.run_mypy("mypy", "--config-file", str(HERE / "mypy.ini"), file.name)
        self.assertIn(':3: error: Unexpected keyword argument "k" for "Revolute"', done.stdout)
        self.assertNotIn(":2: error", done.stdout)


class Examples(unittest.TestCase):
    def test_of_the_package_are_true(self):
        names = [module.name for module in pkgutil.iter_modules(catena.__path__) if module.name != "_catena"]
        attempted = 0
        for module in [catena, *(importlib.import_module("catena." + name) for name in names)]:
            result = doctest.testmod(module)
            self.assertEqual(result.failed, 0, module.__name__)
            attempted += result.attempted
        self.assertGreater(attempted, 30)


class Tutorial(unittest.TestCase):
    """Blocks of apps/manual/python.md, opened by ```python, run one after the other at the top of the tree."""

    def test_runs_as_it_stands(self):
        for package in ("matplotlib", "pandas"):
            if not importlib.util.find_spec(package):
                self.skipTest(f"{package} is not installed")
        import matplotlib

        matplotlib.use("Agg")
        text = (ROOT / "apps/manual/python.md").read_text(encoding="utf-8")
        blocks = list(re.finditer(r"^```python\n(.*?)^```$", text, re.DOTALL | re.MULTILINE))
        self.assertGreater(len(blocks), 5)
        names = {"__name__": "tutorial"}
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(ROOT / "data", os.path.join(folder, "data"))
            os.chdir(folder)
            try:
                for block in blocks:
                    # Lines of the page are those of messages.
                    lines = "\n" * text[: block.start(1)].count("\n")
                    exec(compile(lines + block.group(1), "apps/manual/python.md", "exec"), names)
            finally:
                os.chdir(before)


if __name__ == "__main__":
    unittest.main()
