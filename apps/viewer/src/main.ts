// The page: reads its data, ties mechanism, clock, plots and reports together.

import { PageData } from "./contract";
import { byId } from "./dom";
import { Page } from "./page";

function main(): void {
  const text = byId("catena-data").textContent ?? "";
  const data = JSON.parse(text) as PageData;
  if (data.catena_view !== 1) throw new Error(`data of version ${data.catena_view}: this page reads version 1`);
  const page = new Page(data);
  // For tests, and for the browser's console.
  Object.assign(window, { catena: page });
}

try {
  main();
} catch (error) {
  document.body.prepend(document.createTextNode(`This page cannot be shown: ${String(error)}`));
  throw error;
}
