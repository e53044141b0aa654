// Runs Khronos' glTF validator on a file: node validate_glb.mjs FILE.glb FOLDER
// FOLDER is where the npm module gltf-validator is, or will be installed. Exit 77: skipped (no module, no network).
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';

const [file, folder] = process.argv.slice(2);
const home = join(folder, 'node_modules', 'gltf-validator');
if (!existsSync(home)) {
  mkdirSync(folder, { recursive: true });
  try {
    execFileSync('npm', ['install', '--no-audit', '--no-fund', '--prefix', folder, 'gltf-validator'], { stdio: 'pipe', timeout: 120000 });
  } catch (error) {
    console.log(`skipped: npm could not fetch gltf-validator into ${folder} (${String(error.message).split('\n')[0]})`);
    process.exit(77);
  }
}
const validator = createRequire(join(folder, 'anchor.js'))('gltf-validator');
const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), { uri: file, maxIssues: 200 });
const { numErrors, numWarnings, numInfos, messages } = report.issues;
console.log(`${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos`);
for (const m of messages.slice(0, 40)) console.log(`${['error', 'warning', 'info', 'hint'][m.severity]} ${m.code} ${m.pointer ?? ''}: ${m.message}`);
console.log(JSON.stringify({ drawCalls: report.info.drawCallCount, triangles: report.info.totalTriangleCount, materials: report.info.materialCount }));
process.exit(numErrors > 0 || numWarnings > 0 ? 1 : 0);
