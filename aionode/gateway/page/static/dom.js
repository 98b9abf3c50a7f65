// Small helpers for elements. Texts of the robot become text, never markup.

/** Return a new element with these properties and children. */
export function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

/** Fill a select with these values; keep the selected one, if it still exists. */
export function fill(select, values, empty) {
  const shown = [...select.options].map((option) => option.value).join("\n");
  if (shown === ["", ...values].join("\n")) return;
  const chosen = select.value;
  select.replaceChildren(
    element("option", { value: "", textContent: empty }),
    ...values.map((value) => element("option", { value, textContent: value })),
  );
  select.value = values.includes(chosen) ? chosen : "";
}

/** Put an empty copy of a view behind those that are there, and return it. */
export function another(view) {
  const made = view.cloneNode(true);
  for (const part of made.querySelectorAll("select, .legend, .caption")) part.replaceChildren();
  view.parentNode.append(made);
  return made;
}

/** Show a notice above the panels for a while. */
export function notice(text) {
  const place = document.getElementById("notice");
  place.textContent = text;
  place.hidden = !text;
  clearTimeout(notice.timer);
  notice.timer = setTimeout(() => { place.hidden = true; }, 8000);
}

/** Yield the path and value of each plain value in a message; long arrays are truncated. */
export function* leaves(value, path = "") {
  const isArray = Array.isArray(value) || ArrayBuffer.isView(value);
  if (isArray && value.length > 16) {
    yield [path, `[${value.length}] ${Array.from(value.slice(0, 8), short).join(", ")}, …`];
  } else if (isArray) {
    if (!value.length) yield [path, "[]"];
    for (let index = 0; index < value.length; index++) yield* leaves(value[index], `${path}[${index}]`);
  } else if (value !== null && typeof value === "object") {
    for (const [name, field] of Object.entries(value)) yield* leaves(field, path ? `${path}.${name}` : name);
  } else yield [path, value];
}

export function short(value) {
  if (typeof value === "number" && !Number.isInteger(value)) return value.toPrecision(6);
  if (typeof value === "object" && value !== null) return "{…}";
  return String(value);
}
