// The page on a phone: nothing wider than the screen, everything within reach.

import { check, makePage, outputFolder, scene, settle, test } from "./page_test.mjs";

const made = makePage(scene("excavator_arm"), "phone");

// Chromium's windows are no narrower than 500 px.
await test({ width: 500, height: 880 }, async (page) => {
  await page.open(made.page);
  await settle(page);
  const { wide, seen } = await page.run("return { wide: document.documentElement.scrollWidth, seen: innerWidth }");
  check(wide <= seen, `the page is ${wide} px wide on a screen of ${seen} px`);
  const small = await page.run(`
    return [...document.querySelectorAll("#buttons button, header button")]
        .filter((b) => b.getBoundingClientRect().width < 32 || b.getBoundingClientRect().height < 30).length`);
  check(small === 0, `${small} buttons are too small for fingers`);
  await page.screenshot(`${outputFolder}/phone.png`);
});
