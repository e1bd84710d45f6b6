// Names for what Bokeh draws without one: for screen readers, and for whoever works without a mouse.
const all = (selector, root = document) => [...root.querySelectorAll('*')].flatMap(each => [
  ...(each.matches(selector) ? [each] : []),
  ...(each.shadowRoot ? all(selector, each.shadowRoot) : []),
]);
const give = (elements, names) => elements.forEach((element, place) => {
  if (names[place] && element.getAttribute('aria-label') !== names[place])
    element.setAttribute('aria-label', names[place]);
});
const name = () => {
  document.querySelector('[data-root-id] > *')?.setAttribute('role', 'main');
  give(all('.noUi-handle'), parameters);
  give(all('input.bk-input'), parameters.map(each => `${each}, as a number`));
  give(all('.bk-spin-btn'), parameters.flatMap(each => [`${each}, up`, `${each}, down`]));
  give(all('select'), lists);
  // Tab passes by what has no use without a mouse: arrow keys change the numbers, too.
  all('.bk-spin-btn, .bk-events').forEach(each => { each.tabIndex = -1; });
  // A finger that moves to the side drags a rod or a picture, one that moves up or down the page.
  all('.bk-events').forEach(each => { each.style.touchAction = 'pan-y pinch-zoom'; });
  const fold = all('button').find(each => each.textContent.trim() === more);
  fold.setAttribute('aria-expanded', fold.classList.contains('bk-active'));
  all('button').forEach(each => {
    const speed = /^[0-9.]+$/.test(each.textContent.trim());
    if (!speed) return;
    each.setAttribute('aria-label', `speed ${each.textContent.trim()} T per second`);
    each.setAttribute('aria-pressed', each.classList.contains('bk-active'));
  });
};
name();
document.getElementById('first')?.remove();  // what stood here while the libraries were loading
setInterval(name, 1000);  // widgets are made anew when what they offer changes
