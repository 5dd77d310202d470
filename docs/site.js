document.addEventListener("DOMContentLoaded", () => {
  for (const table of document.querySelectorAll(".content table")) {
    label(table);
    for (const cell of table.querySelectorAll("td")) letBreak(cell);
  }
});

// On a telephone a table of words stands line by line (site.css): there each cell says of which column it is.
function label(table) {
  const titles = [...table.querySelectorAll("thead th")].map((title) => title.textContent.trim());
  for (const row of table.querySelectorAll("tbody tr"))
    [...row.cells].forEach((cell, column) => {
      if (column > 0 && titles[column]) cell.dataset.column = titles[column] + ": ";
    });
}

// Long names may go on in the next line behind a slash: visualization_msgs/InteractiveMarkerUpdate.
function letBreak(cell) {
  const texts = document.createTreeWalker(cell, NodeFilter.SHOW_TEXT);
  const long = [];
  while (texts.nextNode()) if (/\w\/\w/.test(texts.currentNode.data)) long.push(texts.currentNode);
  for (const text of long) {
    const parts = text.data.split(/(?<=\w\/)(?=\w)/);
    text.replaceWith(...parts.flatMap((part, i) => (i === 0 ? [part] : [document.createElement("wbr"), part])));
  }
}
