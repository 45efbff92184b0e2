// The page on a phone: nothing wider than the screen, everything within reach.

import { check, makePage, outputFolder, scene, settle, test } from "./page_test.mjs";

const made = makePage(scene("excavator_arm"), "phone");

await test({ width: 360, height: 740, phone: true }, async (page) => {
  await page.open(made.page);
  await settle(page);
  check((await page.run("return innerWidth")) === 360, "the screen is as narrow as a phone's");
  const { wide, seen } = await page.run("return { wide: document.documentElement.scrollWidth, seen: innerWidth }");
  check(wide <= seen, `the page is ${wide} px wide on a screen of ${seen} px`);
  const small = await page.run(`
    return [...document.querySelectorAll("#buttons button, header button")]
        .filter((b) => b.getBoundingClientRect().width < 32 || b.getBoundingClientRect().height < 30).length`);
  check(small === 0, `${small} buttons are too small for fingers`);
  await page.screenshot(`${outputFolder}/phone.png`);
  // The head takes two lines at most, so that the mechanism, the time bar and the tabs are seen at once.
  const [head, tabs] = await page.run(`
    return [document.querySelector("header"), document.getElementById("tabs")].map((e) => e.getBoundingClientRect().bottom)`);
  check(head <= 110, `the head of the page ends at ${head} px`);
  check(tabs <= 740, `the tabs end at ${tabs} px, below the screen`);
  for (const tab of ["report", "table", "points"]) {
    await page.run(`catena.showTab("${tab}")`);
    await settle(page);
    const width = await page.run("return document.documentElement.scrollWidth");
    check(width <= 360, `the page with ${tab} is ${width} px wide`);
  }
});
