// Writes pages of all kinds of studies and opens each in a browser without a window, on a screen and on a phone, by day and by night:
// nothing in the console, no request to anywhere, marks in every figure, every axis of numbers with its unit, no text on another, a
// table behind every figure, no table wider than its column. On some of them a value at the pointer, the first screen on one screen,
// at most four pages of paper. Leaves screenshots. Without Chromium it is skipped: exit code 77.
//
// usage: node open_in_browser.mjs ZEROCOUNT ROOT CHROMIUM SCREENSHOTS [few]
// few: the page of a sweep and that of a tuning, which have most kinds of figures
import {execFileSync} from "node:child_process";
import {mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {createRequire} from "node:module";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {pathToFileURL} from "node:url";

const [zerocount, root, chromiumPath, screenshots, few] = process.argv.slice(2);
if (chromiumPath.endsWith("NOTFOUND")) {
  console.log("SKIPPED: no chromium, chromium-browser or google-chrome was found when the build was configured; " +
              "pages are looked at in one (Debian: apt-get install chromium, then cmake again)");
  process.exit(77);
}
const {chromium} = createRequire(join(root, "analysis/report/package.json"))("playwright-core");
const folder = mkdtempSync(join(tmpdir(), "zerocount-report-"));
let failures = 0;
let checks = 0;

function expect(condition, what) {
  ++checks;
  if (condition) return;
  ++failures;
  console.error(`FAILED: ${what}`);
}

const hostile = "</script><script>window.broken = true</script><!-- <img src=x onerror=\"window.broken = true\">";
const rich = `zerocount: 1
name: ${JSON.stringify("rich " + hostile)}
description: ${JSON.stringify(hostile)}
seed: 7
trials: 40
friction:
  k1: {profile: {mean: 110, cv: 0.15, correlation_length: 0.3, marginal: lognormal}}
  k2: {uniform: [600, 900]}
  lambda: 0.5
command: {targets: [{integers: [1, 10]}], hold: 0.15}
initial: {encoder_phase: {uniform: [0, 1]}, position: {uniform: [0, 6.283185307179586]}}
verdict: {dwell: 0.02, window: 0.02}
sweep: {grid: {controller.kp: [0, 2.0e-4, 4.0e-4], controller.ki: {logspace: [2.0e-5, 3.0e-4, 6]}}}
`;

function report(name, manifest, more = []) {
  writeFileSync(join(folder, `${name}.yaml`), manifest);
  execFileSync(zerocount, ["run", `${name}.yaml`, "-o", `${name}.h5`], {cwd: folder, stdio: "pipe"});
  execFileSync(zerocount, ["report", `${name}.h5`, "-o", `${name}.html`, ...more], {cwd: folder, stdio: "pipe"});
  return join(folder, `${name}.html`);
}

/// The page of an identification, with a masked interval, of a file with a hostile name.
function identification() {
  writeFileSync(join(folder, "tests.yaml"), shipped("identification", 1));
  execFileSync(zerocount, ["run", "tests.yaml", "-o", "tests.h5"], {cwd: folder, stdio: "pipe"});
  const steps = "<img src=x onerror='window.broken = true'>.csv";
  execFileSync(zerocount, ["trace", "tests.h5", "--point", "steps", "-o", steps], {cwd: folder, stdio: "pipe"});
  execFileSync(zerocount, ["identify", "tests.h5", "--point", "ramps", steps, "--counts-per-revolution", "1620000",
    "--exclude", "0.3:0.35", "--fix", "friction.n=2", "--plot", "fit.html"], {cwd: folder, stdio: "pipe"});
  return join(folder, "fit.html");
}

/// The page of a tuning, of a study with a hostile name.
function tuning() {
  writeFileSync(join(folder, "axis.yaml"), `zerocount: 1
name: ${JSON.stringify("tuned " + hostile)}
seed: 7
trials: 100
machines: 50
command: {targets: [29], hold: 0.2}
friction: {k1: {lognormal: {median: 130, cv: 0.2}, per: machine}}
goal: {band: 1, within: 0.1, moves: 0.9}
tune: {free: {controller.ki: {log: [5.0e-6, 1.0e-3]}, controller.kp: [0, 5.0e-3]}}
`);
  execFileSync(zerocount, ["tune", "axis.yaml", "-o", "tuned.h5", "--budget", "70000", "--extras", "room,limits,maps",
    "--report", "tuned.html"],
    {cwd: folder, stdio: "pipe"});
  return join(folder, "tuned.html");
}

/// A shipped manifest with fewer trials, and with the same for other keys of its first level.
const shipped = (name, trials, more = {}) => Object.entries({trials, ...more}).reduce((text, [key, number]) =>
  text.replace(new RegExp(`^${key}: \\d+`, "m"), `${key}: ${number}`), readFileSync(join(root, `experiments/manifests/${name}.yaml`), "utf8"));

async function open(browser, path, width) {
  const phone = width < 500;
  const context = await browser.newContext({colorScheme: "light", viewport: {width, height: 900}, isMobile: phone, hasTouch: phone});
  const page = await context.newPage();
  const said = [];
  const requests = [];
  page.on("console", message => said.push(message.text()));
  page.on("pageerror", error => said.push(error.message));
  page.on("request", request => requests.push(request.url()));
  await page.goto(pathToFileURL(path).href);
  await page.waitForFunction(() => document.documentElement.dataset.drawn === "yes", null, {timeout: 30000});
  return {context, page, said, requests, width, name: `${path.split("/").pop()} ${width}`};
}

/// What must hold of every page, however it is opened.
async function checkPage({page, said, requests, name, width}) {
  expect(said.length === 0, `${name}: the console is empty: ${said.join("; ")}`);
  expect(requests.length === 1, `${name}: only the page itself is asked for: ${requests.join(" ")}`);
  expect(!(await page.evaluate(() => window.broken)), `${name}: nothing of the manifest is run`);
  const [content, screen] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
  expect(content <= screen, `${name}: ${content} pixels fit into ${screen}`);
  const figures = await page.evaluate(() => [...document.querySelectorAll("figure")].map(figure => {
    const plot = figure.querySelector(".plot").getBoundingClientRect();
    const svg = figure.querySelector(".plot svg");
    const marks = [...figure.querySelectorAll(".plot svg .role-mark path, .plot svg .role-mark rect, .plot svg .role-mark line")];
    const drawn = marks.filter(mark => mark.getBoundingClientRect().width + mark.getBoundingClientRect().height > 1);
    return {name: figure.id, marks: drawn.length, fits: !!svg && svg.getBoundingClientRect().right <= plot.right + 1,
            repeated: [...figure.querySelectorAll(".plot svg .role-axis-label")].map(axis => [...axis.querySelectorAll("text")]
              .filter(label => label.getAttribute("opacity") !== "0" && label.textContent !== "").map(label => label.textContent))
              .filter(labels => new Set(labels).size < labels.length).map(labels => labels.join(" | ")),
            titles: figure.querySelectorAll(".plot svg .role-axis-title").length, caption: figure.querySelector("figcaption").textContent.length};
  }));
  await checkWidths({page, name, width});
  await checkTexts({page, name});
  expect(figures.length > 0, `${name}: there are figures`);
  for (const figure of figures) {
    expect(figure.marks > 0, `${name}: ${figure.name} has marks`);
    expect(figure.fits, `${name}: ${figure.name} fits its place`);
    expect(figure.titles > 0, `${name}: ${figure.name} names its axes`);
    expect(figure.repeated.length === 0, `${name}: ${figure.name} repeats labels of an axis: ${figure.repeated.join("; ")}`);
    expect(figure.caption > 60, `${name}: ${figure.name} has a caption`);
  }
}

// Titles of axes of numbers whose unit the words themselves say, or that have none.
const withoutUnit = /^counts$|jerks per second|in margins|^friction\.n$/;

/// No visible text lies on another, and every axis of numbers has a title with a unit, or "%" or units at its labels.
async function checkTexts({page, name}) {
  const {overlaps, axes} = await page.evaluate(() => {
    const visible = element => !element.closest("script,style,noscript,[opacity='0'],details:not([open]) > :not(summary)") &&
      element.checkVisibility({visibilityProperty: true});
    const texts = [];
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      if (!node.textContent.trim() || !visible(node.parentElement)) continue;
      const range = document.createRange();
      range.selectNodeContents(node);
      for (const box of range.getClientRects())
        if (box.width > 1 && box.height > 1) texts.push({node, box, text: node.textContent.trim()});
    }
    texts.sort((a, b) => a.box.top - b.box.top);
    const overlaps = [];
    for (let i = 0; i < texts.length; ++i) {
      for (let k = i + 1; k < texts.length && texts[k].box.top < texts[i].box.bottom; ++k) {
        const [a, b] = [texts[i], texts[k]];
        const across = Math.min(a.box.right, b.box.right) - Math.max(a.box.left, b.box.left);
        const down = Math.min(a.box.bottom, b.box.bottom) - b.box.top; // boxes of lines of text have room above and below
        if (across > 1.5 && down > 0.3 * Math.min(a.box.height, b.box.height) && a.node !== b.node && a.text !== b.text)
          overlaps.push(`${a.node.parentElement.closest("[id]")?.id}: "${a.text.slice(0, 40)}" on "${b.text.slice(0, 40)}"`);
      }
    }
    const axes = [...document.querySelectorAll("figure")].flatMap(figure => [...figure.querySelectorAll(".plot svg .role-axis")].map(axis => {
      const of = role => [...axis.querySelectorAll(`.${role} text`)].filter(visible).map(text => text.textContent).filter(Boolean);
      return {figure: figure.id, labels: of("role-axis-label"), title: of("role-axis-title").join(" ")};
    }));
    return {overlaps, axes};
  });
  expect(overlaps.length === 0, `${name}: no text lies on another: ${overlaps.slice(0, 5).join("; ")}`);
  for (const {figure, labels, title} of axes.filter(({labels}) => labels.some(label => /^−?[0-9.]+( .*)?$/.test(label)))) {
    const hasUnit = / \([^()]+(\([^()]*\)[^()]*)*\)$/.test(title) || withoutUnit.test(title) || labels.every(label => / [%a-zA-Zµ]+$|^0$/.test(label));
    expect(title !== "" && hasUnit, `${name}: an axis of ${figure} has a title with a unit: "${title}", ${labels.slice(0, 3).join(" ")}`);
  }
}

/// By night too the texts of the figures stand out from the paper.
async function checkNight({page, name}) {
  await page.emulateMedia({colorScheme: "dark"});
  const dim = await page.evaluate(() => {
    const luminance = colour => {
      const parts = colour.match(/[\d.]+/g).slice(0, 3).map(part => part / 255).map(part => part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4);
      return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2];
    };
    const paper = luminance(getComputedStyle(document.documentElement).backgroundColor);
    const contrast = text => (luminance(getComputedStyle(text).fill) + 0.05) / (paper + 0.05);
    return [...document.querySelectorAll(":is(.role-axis, .role-legend) text")].filter(text => contrast(text) < 4.5).map(text => text.textContent);
  });
  expect(dim.length === 0, `${name}: texts can be read by night: ${dim.slice(0, 5).join("; ")}`);
}

/// The blocks of the diagram hold their text and do not overlap.
async function checkDiagram({page, name}) {
  const wrong = await page.evaluate(() => {
    const blocks = [...document.querySelectorAll(".axis>.block")].map(block => [block, block.getBoundingClientRect()]);
    const overlap = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    const pairs = blocks.flatMap(([a, first], i) => blocks.slice(i + 1).filter(([, second]) => overlap(first, second)).map(([b]) => `${a.className} on ${b.className}`));
    const lost = blocks.flatMap(([block, frame]) => [...block.querySelectorAll("b,span")]
      .filter(text => !text.closest(".disturbance") && (text.scrollWidth > text.clientWidth || text.getBoundingClientRect().bottom > frame.bottom))
      .map(text => text.textContent));
    return [...(blocks.length >= 4 ? [] : [`${blocks.length} blocks`]), ...pairs, ...lost];
  });
  expect(wrong.length === 0, `${name}: the blocks of the diagram hold their text: ${wrong.join("; ")}`);
}

/// No table is wider than its column, folded ones and those behind figures included.
async function checkWidths({page, name, width}) {
  const wide = await page.evaluate(async phone => {
    for (const details of document.querySelectorAll("details")) details.open = true;
    await new Promise(resolve => setTimeout(resolve, 300));
    const scrolls = phone ? ":not(.data table)" : ""; // on a phone the data of figures scroll
    const found = [...document.querySelectorAll(`table${scrolls},pre`)].filter(one => {
      const column = one.parentElement;
      return one.scrollWidth > column.clientWidth + 1 || one.getBoundingClientRect().right > column.getBoundingClientRect().right + 1;
    }).map(one => `${(one.closest("figure,section") ?? one).id} ${one.scrollWidth}: ${one.textContent.slice(0, 40)}`);
    for (const details of document.querySelectorAll("details")) details.open = false;
    return found;
  }, width < 500);
  expect(wide.length === 0, `${name}: no table is wider than its column: ${wide.join("; ")}`);
}

/// Prints the page on A4, on at most so many pages.
async function checkPrint({page, name}, path, most) {
  const pdf = (await page.pdf({path, format: "A4", printBackground: true})).toString("latin1");
  const pages = pdf.match(/\/Type\s*\/Page\b/g).length;
  expect(pages <= most, `${name}: ${pages} pages of paper, at most ${most}`);
}

async function checkTables({page, name}) {
  for (const details of await page.locator("figure details").all()) {
    await details.locator("summary").click();
    await details.locator("table").waitFor({timeout: 5000}).catch(() => {});
    const rows = await details.locator("tbody tr").count();
    const heads = await details.locator("th").count();
    expect(rows > 0 && heads > 1, `${name}: a table of ${rows} rows and ${heads} columns`);
    await details.locator("summary").click();
  }
}

/// The pointer goes over the marks of a figure until one tells its values.
async function checkHover({page, name}, figure, words) {
  const plot = page.locator(`#figure-${figure} .plot`);
  await plot.scrollIntoViewIfNeeded();
  const marks = await plot.locator(".mark-symbol path, .mark-rect path").all();
  for (const mark of marks.slice(0, 10)) {
    await mark.hover({force: true}).catch(() => {});
    const tooltip = page.locator("#vg-tooltip-element.visible");
    if (await tooltip.waitFor({timeout: 1000}).then(() => true, () => false)) {
      const text = await tooltip.textContent();
      expect(text.includes(words) && /\d/.test(text), `${name}: the pointer over ${figure} shows ${words} and a value: ${text}`);
      return;
    }
  }
  expect(false, `${name}: the pointer over ${figure} shows a value`);
}

/// The star of a map lies on a cell whose loops keep the margins.
async function checkStar({page, name}, figure) {
  const margins = await page.evaluate(figure => {
    const {data} = JSON.parse(document.getElementById("figures").textContent).figures.find(one => one.name === figure);
    const rows = name => data.find(one => one.name === name);
    const objects = ({columns, rows}) => rows.map(row => Object.fromEntries(columns.map(([field], i) => [field, row[i]])));
    const [star] = objects(rows("tuned"));
    return objects(rows("cells")).filter(cell =>
      cell.x_from <= star.x && star.x < cell.x_to && cell.y_from <= star.y && star.y < cell.y_to).map(cell => cell.margins);
  }, figure);
  expect(margins.length === 1 && margins[0] === "kept", `${name}: the cell of ${figure}'s star keeps the margins: ${margins}`);
}

/// The security policy stops scripts and texts of code that are not those of the page. The console tells of it: a last check.
async function checkPolicy({page, name}) {
  const ran = await page.evaluate(() => {
    const script = document.createElement("script");
    script.textContent = "window.injected = true";
    document.body.append(script);
    // The debugger's own evaluation may evaluate texts; what it leaves to a timer may not.
    return new Promise(resolve => setTimeout(() => {
      let evaluated = true;
      try {
        new Function("return 1")();
      } catch {
        evaluated = false;
      }
      resolve({injected: window.injected === true, evaluated});
    }, 0));
  });
  expect(!ran.injected, `${name}: no other script is run`);
  expect(!ran.evaluated, `${name}: no text is evaluated as code`);
}

const options = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync"];
let browser;
try {
  mkdirSync(screenshots, {recursive: true});
  const paper = [["paper-fig4", 5], ["paper-fig6", 5], ["paper-fig7", 20], ["paper-fig8", 20]];
  const has = async ({page, name}, ...figures) => {
    for (const figure of figures) expect(await page.locator(`#figure-${figure}`).count() === 1, `${name}: ${figure}`);
  };
  const onOneScreen = async ({page, name}) => {
    const bottom = await page.evaluate(() => document.getElementById("overview").getBoundingClientRect().bottom);
    expect(bottom <= 900, `${name}: the first screen ends at ${bottom} of 900 pixels`);
  };
  // The page, what must hold of it on a screen and on a phone, and what is looked at on a screen only.
  const pages = [
    {few: true, write: () => report("rich", rich), always: opened => has(opened, "success", "stability-map", "settling-time", "rotor-friction\\.k1", "bode"),
     once: async opened => {
       await checkTables(opened);
       await checkHover(opened, "stability-map", "success rate");
       await checkHover(opened, "settling-time", "by (s)");
     }},
    {write: () => report("stage", shipped("two-step-stage", 320, {machines: 40})), always: checkDiagram, once: async opened => {
      await onOneScreen(opened);
      await checkPrint(opened, join(screenshots, "stage.pdf"), 4);
    }},
    ...paper.map(([name, trials]) => ({write: () => report(name, shipped(name, trials)), always: opened => has(opened, name)})),
    {write: () => report("ages", shipped("million-cycles", 160, {machines: 10})), always: opened => has(opened, "ages", "lives")},
    {write: () => report("worlds", shipped("unknown-friction", 60, {worlds: 3})), always: opened => has(opened, "worlds", "world-rate-1")},
    {write: () => report("parameters", shipped("which-parameters", 90)), always: async ({page, name}) =>
      expect(await page.locator("[id^=figure-sensitivity]").count() > 0, `${name}: there is a figure of sensitivities`)},
    {write: () => report("linear", shipped("linear-stage", 24)), always: checkDiagram},
    {write: identification, always: opened => has(opened, "record-1", "record-2"), once: async opened => {
      await checkTables(opened);
      await checkHover(opened, "record-2", "residual");
    }},
    {few: true, write: tuning, always: async opened => {
      await has(opened, "tuning-map-1-2", "tuning-frontier", "tuning-room", "response");
      await checkDiagram(opened);
    }, once: async opened => {
      await checkTables(opened);
      await checkHover(opened, "tuning-map-1-2", "margins");
      await checkStar(opened, "tuning-map-1-2");
      await checkPrint(opened, join(screenshots, "tuned.pdf"), 4);
    }}];
  browser = await chromium.launch({executablePath: chromiumPath, args: options});
  for (const {write, always, once} of pages.filter(page => page.few || few !== "few")) {
    const path = write();
    for (const width of [1280, 390]) {
      const opened = await open(browser, path, width);
      await checkPage(opened);
      await always(opened);
      if (width === 1280) await once?.(opened);
      const place = scheme => join(screenshots, `${path.split("/").pop().replace(".html", "")}-${scheme}-${width}.png`);
      await opened.page.screenshot({path: place("light"), fullPage: true});
      await checkNight(opened);
      await opened.page.screenshot({path: place("dark"), fullPage: true});
      expect(opened.said.length === 0, `${opened.name}: the console is still empty: ${opened.said.join("; ")}`);
      if (width === 1280 && write === pages[0].write) await checkPolicy(opened);
      await opened.context.close();
    }
  }
} finally {
  await browser?.close();
  rmSync(folder, {recursive: true, force: true});
}
console.log(`${checks} checks, ${failures} failed; screenshots in ${screenshots}`);
process.exit(failures > 0 || checks === 0 ? 1 : 0);
