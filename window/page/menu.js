// A menu under a button: opened by it, left by Escape or by going elsewhere.
import { h } from './html.js';

/** `items` are [label, call]. */
export function openMenu(name, button, items) {
  document.querySelector('.menu')?.remove();
  const close = () => {
    if (menu.isConnected) menu.remove();
    button.focus();
  };
  const menu = h('div', { class: 'menu', role: 'menu', 'aria-label': name }, items.map(([label, call]) => h('button', { role: 'menuitem', onclick: () => {
    close();
    call();
  } }, label)));
  menu.addEventListener('keydown', (event) => {
    if (event.key === 'Escape') close();
    if (event.key === 'ArrowDown' || event.key === 'ArrowUp') {
      event.preventDefault();
      const all = [...menu.children];
      all[(all.indexOf(document.activeElement) + (event.key === 'ArrowDown' ? 1 : all.length - 1)) % all.length].focus();
    }
    event.stopPropagation();
  });
  menu.addEventListener('focusout', (event) => {
    if (event.relatedTarget !== null && !menu.contains(event.relatedTarget)) menu.remove();
  });
  document.body.append(menu);
  const box = button.getBoundingClientRect();
  menu.style.left = `${Math.max(0, Math.min(box.left, window.innerWidth - menu.offsetWidth))}px`;
  menu.style.top = `${Math.max(0, Math.min(box.bottom + 2, window.innerHeight - menu.offsetHeight))}px`;
  menu.firstChild.focus();
}
