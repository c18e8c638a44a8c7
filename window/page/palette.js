// Colours of the page that people with any colour vision tell apart [Okabe and Ito 2008], and the theme of the 3D view.

export const okabeIto = {
  black: '#000000', orange: '#e69f00', skyBlue: '#56b4e9', green: '#009e73',
  yellow: '#f0e442', blue: '#0072b2', vermilion: '#d55e00', purple: '#cc79a7',
};

/** Bodies of the first, second … kind of robot. Yellow is left to what is chosen, vermilion to what is wrong. */
const kinds = [okabeIto.skyBlue, okabeIto.green, okabeIto.purple, okabeIto.orange, okabeIto.blue, '#999999'];
export const kindColor = (kind) => kinds[kind % kinds.length];

/** Lines of a plot; with the dashes they differ without colours too. */
const lines = [okabeIto.blue, okabeIto.vermilion, okabeIto.green, okabeIto.purple, okabeIto.orange, okabeIto.skyBlue];
const dashes = [[], [7, 4], [2, 3], [9, 3, 2, 3], [12, 5], [4, 2]];
export const lineStyle = (number) => ({
  color: lines[number % lines.length],
  dash: dashes[(number + Math.floor(number / lines.length)) % dashes.length],
});

const dark = window.matchMedia('(prefers-color-scheme: dark)');
const themes = {
  light: { sky: '#dfe6ec', ground: '#f5f4f0', grid: '#d8d6ce', wall: '#8d939b', movable: '#d9b26a', border: '#6b7280', ink: '#1b1f24', halo: '#ffffff', post: '#7d858f' },
  dark: { sky: '#14181d', ground: '#2a2f36', grid: '#3a414a', wall: '#77808b', movable: '#b8924e', border: '#9aa4b1', ink: '#e8ecf1', halo: '#14181d', post: '#8a929c' },
};
export const theme = () => (dark.matches ? themes.dark : themes.light);
export const onThemeChange = (call) => dark.addEventListener('change', call);

/** [r, g, b], 0 … 1, of "#rrggbb". */
export function rgb(hex) {
  const n = parseInt(hex.slice(1), 16);
  return [(n >> 16) / 255, ((n >> 8) & 255) / 255, (n & 255) / 255];
}

/** From dark blue over green to yellow, as light as it is large: 0 to 1, as "#rrggbb". */
const scale = [[48, 18, 90], [52, 74, 140], [33, 130, 141], [80, 184, 104], [190, 214, 50], [253, 231, 60]];
export function scaleColor(share) {
  const at = Math.max(0, Math.min(0.9999, share)) * (scale.length - 1), low = Math.floor(at);
  return `#${scale[low].map((value, k) => Math.round(value + (at - low) * (scale[low + 1][k] - value)).toString(16).padStart(2, '0')).join('')}`;
}
