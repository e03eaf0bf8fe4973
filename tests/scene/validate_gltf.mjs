// SPDX-License-Identifier: GPL-3.0-or-later
// A glTF file in, the Khronos validator's report as JSON out:  node validate_gltf.mjs file.glb
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";

// NODE_PATH works for require alone, so that the package may be installed anywhere
const validator = createRequire(import.meta.url)("gltf-validator");
const file = process.argv[2];
const report = await validator.validateBytes(new Uint8Array(await readFile(file)), { uri: file });
console.log(JSON.stringify(report.issues));
