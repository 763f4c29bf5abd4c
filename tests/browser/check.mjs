// Opens reports in a headless Chromium and uses them as a reader does. Usage: node check.mjs
// FOLDER, which holds node_modules and runs.
import { createRequire } from "node:module";
import { statSync } from "node:fs";
import { resolve } from "node:path";

const place = resolve(process.argv[2]);
const { chromium } = createRequire(`${place}/`)("playwright-core");
const flags = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM || "/usr/bin/chromium", args: flags });

let failed = 0;
const check = (name, holds, seen = "") => {
  console.log(`${holds ? "ok    " : "FAILED"} ${name}${holds ? "" : `: ${seen}`}`);
  if (!holds) failed += 1;
};

const open = async (path, options = {}) => {
  const context = await browser.newContext({ viewport: { width: 1200, height: 900 }, ...options });
  const page = await context.newPage();
  const errors = [], asked = [];
  page.on("console", (m) => m.type() === "error" && errors.push(m.text()));
  page.on("pageerror", (e) => errors.push(e.message));
  page.on("request", (r) => !r.url().startsWith("file:") && !r.url().startsWith("data:") && !r.url().startsWith("blob:") && asked.push(r.url()));
  await page.goto(`file://${place}/runs/${path}`);
  await page.waitForSelector("html[data-ready]", { state: "attached", timeout: 120000 });
  return { page, errors, asked, close: () => context.close() };
};

// Pixels of the canvas of the viewer: how many have a colour, how many are not background, and a
// sum that tells pictures apart.
const pixels = (page) => page.evaluate(() => {
  const canvas = document.querySelector("#viewer canvas");
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const ctx = copy.getContext("2d");
  ctx.drawImage(canvas, 0, 0);
  const { data } = ctx.getImageData(0, 0, copy.width, copy.height);
  const near = (a, b) => Math.abs(a - b) < 12;
  let drawn = 0, coloured = 0, red = 0, blue = 0, sum = 0;
  for (let k = 0; k < data.length; k += 4) {
    const [r, g, b] = [data[k], data[k + 1], data[k + 2]];
    if (!(near(r, data[0]) && near(g, data[1]) && near(b, data[2]))) drawn += 1;
    if (Math.max(r, g, b) - Math.min(r, g, b) > 40) coloured += 1;
    if (r > 120 && r > g + 70 && r > b + 70) red += 1;
    if (b > 150 && b > r + 70) blue += 1;
    sum = (sum * 31 + r + 3 * g + 7 * b) % 2147483647;
  }
  return { drawn, coloured, red, blue, sum, total: data.length / 4 };
});
const settle = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
const text = (page, selector) => page.locator(selector).first().textContent();
const wait = async (of, holds, most = 20000) => {
  for (const start = Date.now(); Date.now() - start < most;) { const v = await of(); if (holds(v)) return v; await new Promise((d) => setTimeout(d, 60)); }
  return of();
};
const select = (page, label) => page.locator("#viewer label", { hasText: label }).locator("select").first();

const viewer = async (name, { errors, asked, page }, more = {}) => {
  await page.locator("#scene").scrollIntoViewIfNeeded();
  const canvas = page.locator("#viewer canvas");
  const first = await pixels(page);
  check(`${name}: the canvas shows the scene`, first.drawn > 0.01 * first.total, JSON.stringify(first));
  if (more.bonds) check(`${name}: intact bonds are red, broken ones blue`, first.red > 100 && first.blue > 30, JSON.stringify(first));
  const time = () => text(page, "#viewer .time");
  const end = await time();

  // Every key does what the page says, with the picture in focus.
  await canvas.focus();
  const key = async (keys, what, of = async () => (await pixels(page)).sum) => {
    const before = await of();
    for (const k of [keys].flat()) await page.keyboard.press(k);
    const after = await wait(of, (v) => v !== before, 4000);
    check(`${name}: ${what}`, after !== before, before);
  };
  await key(",", "a key steps back in time", time);
  await key("End", "a key goes to the end", time);
  check(`${name}: which is where it was`, (await time()) === end, await time());
  await key("Home", "a key goes to the start", time);
  await key(".", "a key steps on", time);
  await key("ArrowLeft", "arrows move the picture");
  await key("+", "a key zooms in");
  await key("-", "a key zooms out");
  await key("End", "and to the end again", time);
  await key("0", "a key resets the view");
  await settle(page);
  check(`${name}: to the bit`, (await pixels(page)).sum === first.sum, "another picture");
  if (more.grains !== false) await key("g", "a key changes how grains look");
  if (more.grains !== false) await key(["g", "g"], "and back");
  await key("b", "a key hides first bodies");
  await page.keyboard.press("b");

  // Scrubbing, by hand.
  const shows = async (k) => { await page.locator("#viewer .scrub").fill(String(k)); await page.locator("#viewer .scrub").dispatchEvent("input"); };
  await shows(0);
  check(`${name}: scrubbing shows the start`, /state 1 of/.test(await wait(time, (t) => /state 1 of/.test(t))), await time());
  // Playing runs to the end and stops there. It is slow at first, so that the button is read before
  // the end on a busy machine too.
  await select(page, "speed").selectOption("0.25");
  await page.locator("#viewer .play").click();
  check(`${name}: playing says so`, (await text(page, "#viewer .play")) === "Pause");
  await select(page, "speed").selectOption("4");
  check(`${name}: playing ends at the end`, (await wait(time, (t) => t === end, 90000)) === end, await time());
  await wait(() => text(page, "#viewer .play"), (t) => t === "Play");

  // Colours: every field of the chooser can be shown, with its legend.
  const chooser = select(page, more.grains === false ? "colour meshes" : "colour grains");
  const options = await chooser.locator("option").evaluateAll((list) => list.map((o) => o.value));
  check(`${name}: fields to choose from`, options.length > 2, options.join());
  const plain = (await chooser.selectOption(""), await settle(page), await pixels(page));
  for (const option of options.filter(Boolean)) {
    await chooser.selectOption(option);
    await settle(page);
    const now = await pixels(page);
    check(`${name}: colours by ${option}`, now.sum !== plain.sum && (await text(page, "#viewer .legend")).includes(option.split(" (")[0]), await text(page, "#viewer .legend"));
  }
  // Pointer: zoom by wheel once the picture is in focus, move or turn by dragging, read a value
  // under the pointer.
  await canvas.focus();
  const box = await canvas.boundingBox();
  const middle = [box.x + box.width / 2, box.y + box.height / 2];
  const look = async (what, act) => { const before = (await pixels(page)).sum; await act(); await settle(page); check(`${name}: ${what}`, (await pixels(page)).sum !== before); };
  await page.mouse.move(...middle);
  await look("the wheel zooms", () => page.mouse.wheel(0, -300).then(() => page.waitForTimeout(200)));
  await look("dragging moves it", async () => { await page.mouse.down(); await page.mouse.move(middle[0] + 60, middle[1] + 30, { steps: 3 }); await page.mouse.up(); });
  await page.locator("#viewer button", { hasText: "Reset view" }).click();
  check(`${name}: no errors`, errors.length === 0, errors.join("; "));
  check(`${name}: no requests`, asked.length === 0, asked.join("; "));
};

const charts = async (name, { page }, least) => {
  const found = await page.evaluate(() => [...document.querySelectorAll(".chart canvas")].map((c) => {
    const { data } = c.getContext("2d").getImageData(0, 0, c.width, c.height);
    let coloured = 0;
    for (let k = 0; k < data.length; k += 4) if (data[k + 3] > 100 && Math.max(data[k], data[k + 1], data[k + 2]) - Math.min(data[k], data[k + 1], data[k + 2]) > 50) coloured += 1;
    return coloured;
  }));
  check(`${name}: ${least} charts and more`, found.length >= least, found.length);
  check(`${name}: each has lines`, found.every((n) => n > 40), found.join());
  const labels = await page.locator(".chart .plot").evaluateAll((list) => list.map((p) => p.getAttribute("aria-label")));
  check(`${name}: each says in words what it shows`, labels.every((l) => l && l.includes(" over ")), labels.join(" | "));
};

// Zooming one chart over time zooms the others.
const linked = async (name, { page }) => {
  const plots = page.locator(".chart .plot[aria-label*='over time']");
  const picture = (k) => plots.nth(k).locator("canvas").evaluate((c) => c.toDataURL());
  const before = await picture(1);
  await plots.nth(0).scrollIntoViewIfNeeded();
  await plots.nth(0).focus();
  await page.keyboard.press("+");
  await settle(page);
  const zoomed = await picture(1);
  check(`${name}: a zoom of one chart over time is that of all`, zoomed !== before);
  await page.keyboard.press("Escape");
  await settle(page);
  check(`${name}: and its end`, (await picture(1)) === before);
  const own = plots.nth(0).locator(".u-legend");
  const over = await plots.nth(0).locator(".u-over").boundingBox();
  const empty = await own.textContent();
  await page.mouse.move(over.x + over.width / 2, over.y + over.height / 2);
  check(`${name}: values under the cursor`, (await wait(() => own.textContent(), (t) => t !== empty, 4000)) !== empty, empty);
  // The chooser of columns.
  const any = page.locator(".chart", { hasText: "Any column" });
  const shown = () => any.locator(".plot").getAttribute("aria-label");
  const first = await shown();
  await any.locator("select").first().selectOption("iterations");
  check(`${name}: any column can be chosen`, (await shown()) !== first && (await shown()).startsWith("iterations"), await shown());
  await any.locator("select").nth(2).selectOption("kinetic");
  check(`${name}: over any other`, (await shown()).includes("over kinetic"), await shown());
};

const search = async (name, { page }) => {
  const rows = () => page.locator("#inputs-table tbody tr:visible").count();
  const all = await rows();
  await page.locator("input[data-filters=inputs-table]").fill("solver relax");
  check(`${name}: the search finds an input`, (await rows()) === 1 && all > 50, `${await rows()} of ${all}`);
  await page.locator("input[data-filters=inputs-table]").fill("");
  await page.locator("input[data-hides]").check();
  const given = await rows();
  check(`${name}: what is given can be shown alone`, given > 5 && given < all, `${given} of ${all}`);
};

const narrow = async (name, path) => {
  const phone = await open(path, { viewport: { width: 360, height: 740 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 });
  const width = await phone.page.evaluate(() => document.documentElement.scrollWidth);
  check(`${name}: a phone needs no sideways scroll`, width <= 360, width);
  await phone.page.screenshot({ path: `${place}/${name}-phone.png` });
  if (name !== "compare") {
    await phone.page.locator("#viewer canvas").scrollIntoViewIfNeeded();
    check(`${name}: the scene is there on a phone`, (await pixels(phone.page)).drawn > 500);
    // Two fingers zoom.
    const box = await phone.page.locator("#viewer canvas").boundingBox();
    const before = (await pixels(phone.page)).sum;
    const cdp = await phone.page.context().newCDPSession(phone.page);
    const fingers = (d) => [-1, 1].map((s, id) => ({ x: box.x + box.width / 2 + s * d, y: box.y + box.height / 2, id }));
    await cdp.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: fingers(20) });
    for (const d of [35, 50, 70]) await cdp.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: fingers(d) });
    await cdp.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
    await settle(phone.page);
    check(`${name}: two fingers zoom`, (await pixels(phone.page)).sum !== before);
  }
  check(`${name}: no errors on a phone`, phone.errors.length === 0, phone.errors.join("; "));
  await phone.close();
};

const printed = async (name, { page }) => {
  const file = `${place}/${name}.pdf`;
  if (name !== "compare") await wait(() => page.locator(".still").getAttribute("src"), Boolean);
  await page.pdf({ path: file, format: "A4", printBackground: true });
  check(`${name}: prints`, statSync(file).size > 20000, statSync(file).size);
  await page.emulateMedia({ media: "print" });
  if (name !== "compare") {
    check(`${name}: a picture stands for the viewer in print`, (await page.locator(".still").isVisible()) && !(await page.locator("#viewer canvas").isVisible()));
  }
  check(`${name}: no controls in print`, !(await page.locator("nav").isVisible()));
  await page.emulateMedia({ media: "screen" });
};

// Contrast of what is read, at least 4.5 to 1, and names of what is used.
const accessible = async (name, { page }) => {
  const low = await page.evaluate(() => {
    const parse = (c) => c.match(/[\d.]+/g).map(Number);
    const luminance = ([r, g, b]) => { const f = (v) => ((v /= 255) <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4); return 0.2126 * f(r) + 0.7152 * f(g) + 0.0722 * f(b); };
    const behind = (e) => { for (; e; e = e.parentElement) { const c = parse(getComputedStyle(e).backgroundColor); if (c.length < 4 || c[3] === 1) return c; } return [255, 255, 255]; };
    const bad = [];
    for (const e of document.querySelectorAll("p, th, td, li, a, label, h1, h2, h3, summary, code, .value, .interval, .badge, kbd")) {
      if (!e.offsetParent || !e.textContent.trim()) continue;
      const [a, b] = [luminance(parse(getComputedStyle(e).color)), luminance(behind(e))];
      const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
      if (ratio < 4.5) bad.push(`${e.tagName} ${e.textContent.slice(0, 20)} ${ratio.toFixed(2)}`);
    }
    return bad;
  });
  check(`${name}: text has contrast`, low.length === 0, low.slice(0, 4).join("; "));
  const nameless = await page.evaluate(() => [...document.querySelectorAll("button, select, input, canvas[role], [role=region]")].filter((e) => !(e.getAttribute("aria-label") || e.textContent.trim() || e.closest("label")?.textContent.trim())).length);
  check(`${name}: every control has a name`, nameless === 0, nameless);
};

for (const [name, more, least] of [["bonded", { bonds: true }, 7], ["solid", { bonds: true }, 2], ["balls", {}, 2], ["rubber", { grains: false }, 2]]) {
  const opened = await open(`${name}/report.html`);
  await charts(name, opened, least);
  await viewer(name, opened, more);
  await accessible(name, opened);
  if (name === "bonded") { await linked(name, opened); await search(name, opened); }
  await opened.page.locator("#scene").scrollIntoViewIfNeeded();
  await opened.page.screenshot({ path: `${place}/${name}.png`, fullPage: true });
  await printed(name, opened);
  await opened.close();
  await narrow(name, `${name}/report.html`);
}

const killed = await open("killed/report.html");
check("killed: says that the run did not finish", (await text(killed.page, ".verdict .headline")) === "Not finished");
check("killed: shows what was recorded", (await pixels(killed.page)).drawn > 1000);
await charts("killed", killed, 5);
check("killed: no errors", killed.errors.length === 0, killed.errors.join("; "));
await killed.page.screenshot({ path: `${place}/killed.png` });
await killed.close();

for (const scheme of ["light", "dark"]) {
  const page = await open("compare.html", { colorScheme: scheme });
  check(`compare ${scheme}: one row for each run`, (await page.page.locator("#verdicts tbody tr").count()) === 3);
  check(`compare ${scheme}: inputs that differ`, (await page.page.locator("#differences tbody tr").count()) >= 1);
  await charts(`compare ${scheme}`, page, 5);
  await accessible(`compare ${scheme}`, page);
  check(`compare ${scheme}: no errors`, page.errors.length === 0, page.errors.join("; "));
  if (scheme === "light") await printed("compare", page);
  await page.page.screenshot({ path: `${place}/compare-${scheme}.png`, fullPage: true });
  await page.close();
}
await narrow("compare", "compare.html");

const dark = await open("bonded/report.html", { colorScheme: "dark" });
await accessible("bonded dark", dark);
await dark.page.screenshot({ path: `${place}/bonded-dark.png` });
await dark.close();

await browser.close();
console.log(failed ? `${failed} checks failed` : "all checks passed");
process.exit(failed ? 1 : 0);
