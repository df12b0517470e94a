// SPDX-License-Identifier: Apache-2.0
// ONNX models as npm's onnxruntime-node runs them: onnx_runtime.mjs NODE_MODULES FOLDER NAME:FRAMES...
// NAME.onnx on the float32 values of NAME.in makes NAME.out. Prints the inputs and outputs of each model.
import { createRequire } from "node:module";
import { readFileSync, writeFileSync } from "node:fs";

const [modules, folder, ...runs] = process.argv.slice(2);
const { InferenceSession, Tensor } = createRequire(modules + "/")("onnxruntime-node");

for (const run of runs) {
  const [name, frames] = run.split(":");
  const session = await InferenceSession.create(`${folder}/${name}.onnx`, { intraOpNumThreads: 1 });
  const bytes = readFileSync(`${folder}/${name}.in`);
  const values = new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  const input = new Tensor("float32", values, [1, Number(frames), values.length / Number(frames)]);
  const result = await session.run({ [session.inputNames[0]]: input });
  const output = result[session.outputNames[0]];
  writeFileSync(`${folder}/${name}.out`, new Uint8Array(output.data.buffer, output.data.byteOffset, 4 * output.data.length));
  console.log(JSON.stringify([session.inputNames, session.outputNames, output.dims]));
}
