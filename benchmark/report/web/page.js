// SPDX-License-Identifier: MIT
// What a report does besides its 3-D view: tables that sort, light and dark.
(() => {
  'use strict';

  // A cell's number, without what follows it ("98.1 (4/5)"); NaN for text.
  const numberIn = (text) => parseFloat(text.replace(/,/g, ''));

  const textOf = (row, column) => row.cells[column].textContent.trim();

  const compare = (a, b, column, sign) => {
    const x = textOf(a, column), y = textOf(b, column);
    const p = numberIn(x), q = numberIn(y);
    if (!isNaN(p) && !isNaN(q)) return sign * (p - q);
    if (isNaN(p) !== isNaN(q)) return isNaN(p) ? 1 : -1;  // What has no number comes last.
    return sign * x.localeCompare(y, 'en', {numeric: true});
  };

  const makeSortable = (table) => {
    const headings = [...table.querySelectorAll('thead th[scope="col"]')];
    // Each block of rows is sorted by itself; its heading stays above it.
    const blocks = [...table.tBodies].map((body) => (
      {body, rows: [...body.rows].filter((row) => !row.classList.contains('block'))}));
    if (!blocks.some((block) => block.rows.length > 1)) return;
    headings.forEach((heading, column) => {
      const button = document.createElement('button');
      button.className = 'sort';
      button.type = 'button';
      button.append(...heading.childNodes);
      heading.append(button);
      button.addEventListener('click', () => {
        const now = heading.getAttribute('aria-sort');
        const numeric = heading.classList.contains('number');
        const first = numeric ? 'descending' : 'ascending';
        const second = numeric ? 'ascending' : 'descending';
        const next = now === null ? first : now === first ? second : null;
        headings.forEach((other) => other.removeAttribute('aria-sort'));
        if (next !== null) heading.setAttribute('aria-sort', next);
        const sign = next === 'ascending' ? 1 : -1;
        blocks.forEach(({body, rows}) => {
          body.append(...(next === null ? rows :
            [...rows].sort((a, b) => compare(a, b, column, sign))));
        });
      });
    });
  };

  const darkNow = () => {
    const set = document.documentElement.dataset.theme;
    return set ? set === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
  };

  const stored = (value) => {  // A page from disk may have no storage.
    try {
      if (value !== undefined) localStorage.setItem('raymoval-theme', value);
      return localStorage.getItem('raymoval-theme');
    } catch {
      return null;
    }
  };

  const setUpTheme = () => {
    const button = document.getElementById('theme');
    const tell = () => {
      button.textContent = darkNow() ? 'Light' : 'Dark';
      button.setAttribute('aria-label', `Change to ${darkNow() ? 'light' : 'dark'} colours`);
      document.dispatchEvent(new Event('raymoval-theme'));
    };
    const known = stored();
    if (known === 'dark' || known === 'light') document.documentElement.dataset.theme = known;
    button.addEventListener('click', () => {
      document.documentElement.dataset.theme = darkNow() ? 'light' : 'dark';
      stored(document.documentElement.dataset.theme);
      tell();
    });
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', tell);
    tell();
  };

  document.querySelectorAll('table.sortable').forEach(makeSortable);
  setUpTheme();

  // On paper everything is open and light.
  let opened = [], theme;
  const change = (next) => {
    [theme, document.documentElement.dataset.theme] = [document.documentElement.dataset.theme, next];
    if (next === undefined) delete document.documentElement.dataset.theme;
    document.dispatchEvent(new Event('raymoval-theme'));
  };
  addEventListener('beforeprint', () => {
    change('light');
    opened = [...document.querySelectorAll('details:not([open])')];
    opened.forEach((part) => { part.open = true; });
  });
  addEventListener('afterprint', () => {
    change(theme);
    opened.forEach((part) => { part.open = false; });
  });
})();
