// Makes one file of HTML of the sources: node build.mjs NODE_MODULES OUT
import { createRequire } from 'node:module';
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const [modules, out] = process.argv.slice(2).map((path) => resolve(path));
const here = dirname(fileURLToPath(import.meta.url));
const { build } = createRequire(join(modules, 'x.js'))('esbuild');
const bundle = async (entry, options = {}) => {
  const result = await build({
    entryPoints: [join(here, 'src', entry)], bundle: true, minify: true, write: false, nodePaths: [modules],
    target: 'es2022', legalComments: 'none', charset: 'ascii', logLevel: 'warning', ...options,
  });
  return result.outputFiles[0].text;
};
const script = await bundle('main.js', { format: 'iife' });
const style = await bundle('style.css');
const licences = ['three', 'three-mesh-bvh'].map((name) => {
  const { version, license, homepage } = JSON.parse(readFileSync(join(modules, name, 'package.json')));
  return `${name} ${version} (${license}, ${homepage})`;
});
const put = (text, mark, what) => {
  if (!text.includes(mark)) throw new Error(`index.html has no ${mark}`);
  return text.split(mark).join(what);
};
let page = readFileSync(join(here, 'src', 'index.html'), 'utf8');
page = put(page, '<!--licences-->', `<!-- The viewer of hextwist, GPL-3.0-or-later. Inside: ${licences.join(', ')} -->`);
page = put(page, '/*style*/', style);
page = put(page, '/*script*/', script.replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--'));
writeFileSync(out, page);
