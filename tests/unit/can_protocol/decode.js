// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// Decodes "ID HEXBYTES" lines by a DBC file with the npm package candied: one line of name=value a frame.
const fs = require('fs');
const { Dbc, Can } = require('candied');
const database = new Dbc().load(fs.readFileSync(process.argv[2], 'utf8'));
const can = new Can();
can.database = database;
for (const line of fs.readFileSync(process.argv[3], 'utf8').split('\n')) {
  if (line === '') continue;
  const [id, bytes] = line.split(' ');
  const message = can.decode(can.createFrame(Number(id), [...Buffer.from(bytes, 'hex')]));
  if (!message) throw new Error('unknown frame ' + line);
  const values = [...message.boundSignals].map(([name, signal]) => name + '=' + signal.value);
  console.log(message.name + ' ' + values.join(' '));
}
