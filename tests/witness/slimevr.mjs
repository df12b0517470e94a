// SPDX-License-Identifier: Apache-2.0
// Reads datagrams for trackers from the file `given`, hexadecimal, a line each, and writes what
// @slimevr/firmware-protocol 0.6.6 makes of them to `read`; writes what trackers send to `sent`.
// The folder with both packages is the first argument.
import fs from 'node:fs';
import path from 'node:path';

const at = (name) => path.resolve(process.argv[2], '@slimevr', name, 'dist/esm/index.js');
const p = await import(at('firmware-protocol'));
const { MACAddress, Quaternion, Vector } = await import(at('common'));

const given = fs.readFileSync('given', 'utf8').trim().split('\n');
const read = given.map((line) => p.parse(Buffer.from(line, 'hex'), true)[1].toString());
fs.writeFileSync('read', read.join('\n') + '\n');
// The package reads a sensor info's first two bytes out of its type: it is compared as written.
fs.writeFileSync('acknowledged', new p.DeviceBoundSensorInfoPacket(3, 1).encode().toString('hex'));

const sent = [
  new p.ServerBoundHandshakePacket(9, 4, 2, 17, '0.4.0', new MACAddress([1, 2, 3, 4, 5, 6])).encode(0n),
  new p.ServerBoundHeartbeatPacket().encode(6n),
  new p.ServerBoundRotationDataPacket(2, 1, new Quaternion(0.5, -0.5, 0.25, 1), 0).encode(7n),
  new p.ServerBoundAccelPacket(1, new Vector(1.5, -2.5, 9)).encode(8n),
  new p.ServerBoundSensorInfoPacket(4, 1, 4).encode(9n),
  new p.ServerBoundPongPacket(99).encode(0n),
  new p.ServerBoundBatteryLevelPacket(3.75, 50).encode(10n),
  new p.ServerBoundSignalStrengthPacket(255, -60).encode(11n),
  new p.ServerBoundTemperaturePacket(1, 36.5).encode(12n),
  new p.ServerBoundTapPacket(3, 2).encode(13n),
  new p.ServerBoundErrorPacket(0, 2).encode(14n),
  new p.ServerBoundFeatureFlagsPacket(new p.FirmwareFeatureFlags(new Map([['ROTATION_DATA', true]]))).encode(15n),
];
fs.writeFileSync('sent', sent.map((b) => b.toString('hex')).join('\n') + '\n');
