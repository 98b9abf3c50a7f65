// node roslib_node.mjs PORT path/to/node_modules/roslib/dist/RosLib.js
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { run } from "./roslib_checks.mjs";

const [port, library] = process.argv.slice(2);
const ROSLIB = await import(pathToFileURL(resolve(library)));
const failed = await run(ROSLIB, `ws://localhost:${port}`, console.log);
process.exit(Object.keys(failed).length ? 1 : 0);
