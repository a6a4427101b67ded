"""How the summary of a collection looks, and what makes its tables sort."""

from __future__ import annotations

STYLE = """
:root { color-scheme: light dark; font: 16px/1.5 system-ui, sans-serif; --ink: #1c2430; --soft: #4a5464;
  --line: #d5dae1; --paper: #fff; --ground: #f5f6f8; --accent: #1d4ed8; --bad: #fdecec; --good: #14602f;
  --warn: #a4161a; --bar: #9db7f5; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e9ee; --soft: #b0b8c4; --line: #39414d; --paper: #14181e;
  --ground: #1d232b; --accent: #8fb0ff; --bad: #3b1c1e; --good: #9be0b2; --warn: #ff9c96; --bar: #3d5590; } }
body { max-width: 76rem; margin: 1.5rem auto; padding: 0 clamp(.8rem, 3vw, 1.5rem); color: var(--ink);
  background: var(--paper); }
h1 { font-size: 1.6rem; margin-bottom: 0; overflow-wrap: anywhere; } h2 { font-size: 1.2rem; margin: 2.2rem 0 .6rem; }
.note { color: var(--soft); margin: .2rem 0; } a { color: var(--accent); }
dl { display: grid; grid-template-columns: repeat(auto-fit, minmax(9rem, 1fr)); gap: .9rem; margin: 1.3rem 0; }
dl div { border-left: 3px solid var(--accent); padding-left: .7rem; }
dt { color: var(--soft); font-size: .85rem; } dd { margin: 0; font-size: 1.35rem; font-variant-numeric: tabular-nums; }
.gallery { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(30rem, 100%), 1fr)); gap: 1rem 2rem; }
figure { margin: 0 0 1rem; } figcaption { color: var(--soft); font-size: .9rem; overflow-wrap: anywhere; }
img { max-width: 100%; height: auto; background: #fff; border-radius: 6px; }
.scroll { overflow: auto; max-height: min(80vh, 44rem); } @media print { .scroll { max-height: none; } }
table { border-collapse: collapse; font-size: .85rem; width: 100%; }
th, td { padding: .3rem .8rem .3rem 0; text-align: left; border-bottom: 1px solid var(--line); vertical-align: top; }
th { position: sticky; top: 0; background: var(--paper); white-space: nowrap; }
td.w { min-width: 14rem; } .n { text-align: right; font-variant-numeric: tabular-nums; }
th button { font: inherit; font-weight: 600; color: inherit; background: none; border: 0; padding: 0; cursor: pointer; }
th button::after { content: " \\2195"; color: var(--soft); }
th[aria-sort=ascending] button::after { content: " \\2191"; }
th[aria-sort=descending] button::after { content: " \\2193"; } :focus-visible { outline: 3px solid var(--accent); }
.bad td { background: var(--bad); } .was { color: var(--warn); } .now { color: var(--good); }
td.b { min-width: 5.5rem; } .bar { display: block; color: var(--bar); }
pre { background: var(--ground); padding: 1rem; overflow: auto; font-size: .8rem; } summary { cursor: pointer; }
"""

SCRIPT = """
document.querySelectorAll("table.sorts").forEach(function (table) {
  table.querySelectorAll("th").forEach(function (head, at) {
    var button = document.createElement("button");
    button.type = "button";
    button.textContent = head.textContent;
    head.textContent = "";
    head.appendChild(button);
    button.addEventListener("click", function () {
      var down = head.getAttribute("aria-sort") === "ascending";
      table.querySelectorAll("th").forEach(function (other) { other.removeAttribute("aria-sort"); });
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      var body = table.tBodies[0];
      var value = function (row) {
        var cell = row.cells[at];
        return cell.dataset.v === undefined ? cell.textContent : cell.dataset.v;
      };
      Array.from(body.rows).sort(function (a, b) {
        var x = value(a), y = value(b);
        if (x === "" || y === "") { return (x === "") - (y === ""); }
        var p = Number(x), q = Number(y);
        var order = isNaN(p) || isNaN(q) ? x.localeCompare(y, undefined, { numeric: true }) : p - q;
        return down ? -order : order;
      }).forEach(function (row) { body.appendChild(row); });
    });
  });
});
"""
"""Rows are sorted by the number in a cell's data-v or by its text, empty cells last. Without it all is there too."""
