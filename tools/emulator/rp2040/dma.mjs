// SPDX-License-Identifier: MIT
// DMA: rp2040js's, but each transfer takes a cycle at the least.
//
// There it takes no time, and a channel that starts itself again would never let go.

const CYCLE_NANOS = 8;

export function giveTime(dma) {
  for (const { transferAlarm } of dma.channels) {
    const { schedule } = transferAlarm;
    transferAlarm.schedule = (nanos) => schedule.call(transferAlarm, Math.max(nanos, CYCLE_NANOS));
  }
}
