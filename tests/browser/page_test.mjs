// What tests of pages share: where programs are, pages made by catena, checks that count.
//
//   node <test>.mjs CATENA CHROMEDRIVER CHROMIUM DATA OUTPUT
//
// Screenshots stay in OUTPUT, to be looked at after a change of the page.

import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { startBrowser } from "./webdriver.mjs";

const [catena, driver, browser, dataFolder, output] = process.argv.slice(2);
export const outputFolder = output;
export const data = dataFolder;
mkdirSync(output, { recursive: true });

let failures = 0;
let checks = 0;

export function check(holds, what) {
  ++checks;
  if (holds) return;
  ++failures;
  console.log(`FAILED: ${what}`);
}

export function equal(found, wanted, what) {
  check(found === wanted, `${what}: ${JSON.stringify(found)} instead of ${JSON.stringify(wanted)}`);
}

export function near(found, wanted, tolerance, what) {
  check(Math.abs(found - wanted) <= tolerance, `${what}: ${found} instead of ${wanted} (within ${tolerance})`);
}

export const scene = (name) => join(data, "scenes", `${name}.json`);

export function writeScene(name, content) {
  const path = join(output, `${name}.json`);
  writeFileSync(path, JSON.stringify(content));
  return path;
}

/** The page of a scene; what catena said, its exit code and the size of the file. */
export function makePage(scenePath, name, ...options) {
  const page = join(output, `${name}.html`);
  const run = spawnSync(catena, ["view", scenePath, "-o", page, ...options], { encoding: "utf8", maxBuffer: 1 << 26 });
  return { page, said: run.stderr, exit: run.status, bytes: run.status <= 1 ? statSync(page).size : 0 };
}

/** The results of a scene, as JSON gives them. */
export function results(scenePath, ...options) {
  const said = execFileSync(catena, ["run", "--json", scenePath, ...options], { encoding: "utf8", maxBuffer: 1 << 28 });
  return JSON.parse(said);
}

/** What `catena draw` prints: the figure as SVG. */
export const draw = (scenePath, ...options) =>
    execFileSync(catena, ["draw", scenePath, ...options], { encoding: "utf8", maxBuffer: 1 << 26 });

/** Ends the program with the outcome of all checks. */
export function finish() {
  console.log(`${checks - failures} passed, ${failures} failed`);
  process.exitCode = failures > 0 ? 1 : 0;
}

/** Runs a test with a browser and ends the program with its outcome. */
export async function test(options, body) {
  const page = await startBrowser({ driver, browser, ...options });
  try {
    await body(page);
    const complaints = await page.complaints();
    equal(complaints.join("\n"), "", "errors on the console");
  } catch (error) {
    check(false, error.stack);
  } finally {
    await page.quit();
  }
  finish();
}

/** Waits until the page has drawn what was asked of it. */
export const settle = (page) => page.runAsync(`
    const done = arguments[0];
    const wait = (pictures) => (pictures > 0 ? requestAnimationFrame(() => wait(pictures - 1)) : done(true));
    wait(3);`);
