// The data of pages against their schema, which is strict: a field that it does not name is an error. No browser.

import { readFileSync } from "node:fs";
import { join } from "node:path";

import { check, data, equal, finish, makePage, scene, writeScene } from "./page_test.mjs";

const schema = JSON.parse(readFileSync(join(data, "schema", "catena-view-1.schema.json"), "utf8"));

/** The keywords that occur in the schema; one that is not known is an error, so that none is passed over. */
const known = new Set(["$schema", "$ref", "$defs", "title", "description", "type", "const", "enum", "required", "properties",
                       "additionalProperties", "items", "minItems", "maxItems"]);

function isOf(type, value) {
  if (type === "null") return value === null;
  if (type === "array") return Array.isArray(value);
  if (type === "integer") return Number.isInteger(value);
  if (type === "object") return typeof value === "object" && value !== null && !Array.isArray(value);
  return typeof value === type;
}

/** What does not fit, each with its place; at most some. */
function misfits(value, rule, place, found) {
  if (found.length > 5) return found;
  const wrong = (what) => found.push(`${place}: ${what}`);
  for (const key of Object.keys(rule)) if (!known.has(key)) wrong(`the schema has a keyword ${key}`);
  if (rule.$ref) misfits(value, schema.$defs[rule.$ref.replace("#/$defs/", "")], place, found);
  if (rule.type && ![rule.type].flat().some((type) => isOf(type, value)))
    wrong(`${JSON.stringify(value)?.slice(0, 60)} is no ${rule.type}`);
  if ("const" in rule && value !== rule.const) wrong(`is not ${rule.const}`);
  if (rule.enum && !rule.enum.includes(value)) wrong(`${value} is none of ${rule.enum}`);
  if (Array.isArray(value)) {
    if (value.length < (rule.minItems ?? 0) || value.length > (rule.maxItems ?? Infinity)) wrong(`${value.length} entries`);
    if (rule.items) value.forEach((entry, k) => misfits(entry, rule.items, `${place}[${k}]`, found));
  } else if (isOf("object", value)) {
    for (const key of rule.required ?? []) if (!(key in value)) wrong(`${key} is missing`);
    for (const [key, member] of Object.entries(value)) {
      const own = rule.properties?.[key];
      if (own) misfits(member, own, `${place}.${key}`, found);
      else if (rule.additionalProperties === false) wrong(`${key} is not in the schema`);
      else if (rule.additionalProperties) misfits(member, rule.additionalProperties, `${place}.${key}`, found);
    }
  }
  return found;
}

function dataOf(page) {
  const text = readFileSync(page, "utf8");
  const opening = 'id="catena-data">';
  const from = text.indexOf(opening) + opening.length;
  return JSON.parse(text.slice(from, text.indexOf("</script>", from)));
}

const scenes = ["crank_rocker", "path_generation", "two_bar_truss", "four_bar_gradients", "bouncing_ball", "chain_on_floor", "tackle",
                "planetary_gear", "engine_mount", "excavator_arm", "windscreen_wiper"].map((name) => [name, scene(name)]);
scenes.push(["empty", writeScene("empty", { catena: 1, name: "empty" })]);
for (const [name, path] of scenes) {
  const made = makePage(path, `schema_${name}`, "--units", "angle=deg");
  check(made.exit <= 1, `catena view ${name}: ${made.said}`);
  equal(misfits(dataOf(made.page), schema, name, []).join("\n"), "", `data of ${name}`);
}
// The test itself: what is missing, wrong or unknown is found.
const whole = dataOf(makePage(scene("crank_rocker"), "schema_crank_rocker").page);
for (const [what, change] of [["a missing field", (page) => delete page.units], ["a wrong type", (page) => (page.scene = 3)],
                              ["an unknown field", (page) => (page.analyses[0].colour = "red")]]) {
  const changed = structuredClone(whole);
  change(changed);
  check(misfits(changed, schema, "page", []).length > 0, what);
}
finish();
