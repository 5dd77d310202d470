// On a telephone a table of words stands line by line (site.css): there each cell says of which column it is.
document.addEventListener("DOMContentLoaded", () => {
  for (const table of document.querySelectorAll(".content table")) {
    const titles = [...table.querySelectorAll("thead th")].map((title) => title.textContent.trim());
    for (const row of table.querySelectorAll("tbody tr"))
      [...row.cells].forEach((cell, column) => {
        if (column > 0 && titles[column]) cell.dataset.column = titles[column] + ": ";
      });
  }
});
