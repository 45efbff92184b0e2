// Elements of the page made in one line. Texts are always set as text: names in scenes never become markup.

type Attributes = Record<string, string | boolean>;

export function make<K extends keyof HTMLElementTagNameMap>(
    tag: K, attributes: Attributes = {}, ...children: (Node | string)[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === true) element.setAttribute(name, "");
    else if (value !== false) element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

export function button(label: string, title: string, action: () => void): HTMLButtonElement {
  const element = make("button", { type: "button", title, "aria-label": title }, label);
  element.addEventListener("click", action);
  return element;
}

const icons = {
  play: "M5 3v12l9-6z",
  pause: "M4 3h3.5v12H4zM10.5 3H14v12h-3.5z",
  start: "M3 3h2.5v12H3zM15 3v12L6 9z",
  back: "M12 3v12L4 9z",
  on: "M6 3v12l8-6z",
  loop: "M9 3a6 6 0 1 1-5.6 3.9l1.9.7A4 4 0 1 0 9 5v2.4L5 4l4-3.4z",
  theme: "M9 1a8 8 0 1 0 0 16A8 8 0 0 0 9 1zm0 2v12A6 6 0 0 1 9 3z",
};

/** A picture on a button: no font need have it. */
export function setIcon(element: HTMLElement, name: keyof typeof icons): void {
  const space = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(space, "svg");
  const path = document.createElementNS(space, "path");
  for (const [key, value] of Object.entries({ width: "18", height: "18", viewBox: "0 0 18 18", "aria-hidden": "true" }))
    svg.setAttribute(key, value);
  path.setAttribute("d", icons[name]);
  path.setAttribute("fill", "currentColor");
  path.setAttribute("fill-rule", "evenodd");
  svg.append(path);
  element.replaceChildren(svg);
}

export function iconButton(name: keyof typeof icons, title: string, action: () => void): HTMLButtonElement {
  const element = button("", title, action);
  setIcon(element, name);
  return element;
}

export function byId<T extends HTMLElement>(id: string): T {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the page has no element ${id}`);
  return element as T;
}
