// SPDX-License-Identifier: MIT
// A block: instructions one after the other, up to a jump that is always taken, as a function in C
// (native.h). It does what processor.ts does with each of them, in as many cycles.
//
// Registers are in the memory, and what the block knows of them in variables. The flags go from
// block to block as parameters; inside they are expressions, of which most are never needed. The
// cycles of the instructions are known beforehand: the block asks once whether enough are left, and
// again where it has waited for the flash. What it cannot do it leaves to `interpret`, before that
// instruction: loads and stores elsewhere, rare instructions, the end of the stretch.

const MOST = 64; // instructions
const SP = 13, LR = 14, PC = 15;
const EXCEPTION_RETURN = 15; // the first digit of its addresses
const LINE_SHIFT = 3;
const WORD = 4, HALF = 2, BYTE = 1;
const CLOCK_CYCLES = 4; // to read the timer's count
const AT = { [WORD]: 'WORD', [HALF]: 'HALF', [BYTE]: 'BYTE' };

const hex = (value) => `0x${(value >>> 0).toString(16)}u`;

export class Block {
  // half(address): of the code there, or undefined. isInFlash: the block is.
  constructor(start, half, isInFlash) {
    this.start = start;
    this.half = half;
    this.isInFlash = isInFlash;
    this.instructions = decode(start, half);
    this.bytes = this.instructions.reduce((sum, { bytes }) => sum + bytes, 0);
  }

  // The body of the function. sibling(pc): the name of the block there, if there is one.
  translate(sibling) {
    const { instructions } = this;
    this.sibling = sibling;
    this.code = [];
    this.variables = 0;
    this.known = new Map(); // number of a register: the variable that holds it
    this.flags = { n: 'n', z: 'z', c: 'c', v: 'v' };
    this.compared = null; // the two of which the flags tell the difference
    this.spent = 0; // cycles since the block began, without waiting
    this.total = instructions.reduce((sum, { cycles }) => sum + cycles, 0);
    this.pc = this.start;
    this.line = this.start >>> LINE_SHIFT; // from which the last instruction came
    this.emit(`if ((number)left <= ${this.total}) { PC = ${hex(this.pc)}; ${this.leaving(0)} }`);
    if (this.isInFlash) {
      this.emit(`if (WORD(LINE) != ${hex(this.line)}) { ${this.waitForCode()} }`);
    }
    for (const instruction of instructions) this.execute(instruction);
    if (!instructions.at(-1).ends) this.jump(this.pc, 0);
    return this.code.join('\n');
  }

  execute({ op, bytes, cycles, does }) {
    this.op = op;
    this.cycles = cycles;
    this.next = this.pc + bytes;
    if (this.pc >>> LINE_SHIFT !== this.line) {
      this.line = this.pc >>> LINE_SHIFT;
      if (this.isInFlash) this.emit(this.waitForCode());
    }
    does(this);
    this.spent += cycles;
    this.pc = this.next;
  }

  emit(...statements) {
    this.code.push(...statements);
  }

  // The expression, evaluated once.
  keep(expression) {
    const name = `x${this.variables++}`;
    this.emit(`const word ${name} = ${expression};`);
    return name;
  }

  // Registers

  get(register) {
    if (register === PC) return hex(this.pc + 4);
    if (!this.known.has(register)) this.known.set(register, this.keep(`R(${register})`));
    return this.known.get(register);
  }

  set(register, expression) {
    const value = this.keep(expression);
    this.known.set(register, value);
    this.emit(`R(${register}) = ${value};`);
    return value;
  }

  // The operands, by where the bits of their numbers are.

  get d() { return this.op & 7; }

  get n() { return (this.op >> 3) & 7; }

  get m() { return (this.op >> 6) & 7; }

  get d8() { return (this.op >> 8) & 7; }

  get high() { return ((this.op >> 4) & 8) | (this.op & 7); }

  get anyN() { return (this.op >> 3) & 15; }

  get five() { return (this.op >> 6) & 31; }

  get seven() { return this.op & 0x7f; }

  get eight() { return this.op & 0xff; }

  get list() {
    return [0, 1, 2, 3, 4, 5, 6, 7].filter((register) => this.op & (1 << register));
  }

  // Flags

  sign(value, c = this.flags.c) {
    this.flags = { n: value, z: value, c, v: this.flags.v };
    this.compared = null;
  }

  addition(one, other, sum, c = `(word)(${sum} < ${one})`) {
    const v = `((${one} ^ ${sum}) & (${other} ^ ${sum})) >> 31`;
    this.flags = { n: sum, z: sum, c, v };
    this.compared = null;
  }

  difference(one, other, rest) {
    const v = `((${one} ^ ${other}) & (${one} ^ ${rest})) >> 31`;
    this.flags = { n: rest, z: rest, c: `(word)(${one} >= ${other})`, v };
    this.compared = [one, other];
  }

  // Leaving and going on. more: cycles of the instruction at hand.

  given(more) {
    const { n, z, c, v } = this.flags;
    return `(m, left - ${this.spent + more}, ${n}, ${z}, ${c}, ${v})`;
  }

  leaving(more) {
    return `GO leave${this.given(more)};`;
  }

  // `interpret` goes on with this instruction.
  leave() {
    return `PC = ${hex(this.pc)}; WORD(LINE) = ${hex(this.line)}; ${this.leaving(0)}`;
  }

  // The same with the next one, where the cycles may be spent.
  leaveIfSpent() {
    return `if ((number)left <= ${this.total}) { PC = ${hex(this.next)};`
      + ` WORD(LINE) = ${hex(this.line)}; ${this.leaving(this.cycles)} }`;
  }

  jumping(target, more) {
    const before = `PC = ${hex(target)}; WORD(LINE) = ${hex(this.line)};`;
    return `${before} GO ${this.sibling(target) ?? 'dispatch'}${this.given(more)};`;
  }

  jump(target, more) {
    this.emit(this.jumping(target, more));
  }

  jumpTo(target) {
    this.emit(`PC = ${target} & ~1u; WORD(LINE) = ${hex(this.line)};`,
      `GO dispatch${this.given(this.cycles)};`);
  }

  needNoException(target) {
    this.emit(`if (${target} >> 28 == ${EXCEPTION_RETURN}) { ${this.leave()} }`);
  }

  // Waiting for the flash

  waitForCode() {
    return `left -= wait(m, ${hex(this.line)});`
      + ` if ((number)left <= ${this.total}) { ${this.leave()} }`;
  }

  // Loads and stores

  load(register, sum, bytes, isSigned = false) {
    const address = this.keep(sum), value = `x${this.variables++}`;
    const content = `${isSigned ? 'SIGNED_' : ''}${AT[bytes]}(${address})`;
    const near = bytes !== WORD ? '' : `if (is_near(${address})) {`
      + ` R(${register}) = ${value} = load_near(m, ${address}); left += 1;`
      + ` } else if (is_clock(${address})) {`
      + ` R(${register}) = ${value} = load_clock(m, ${address}, left - ${this.spent});`
      + ` left -= ${CLOCK_CYCLES - this.cycles}; ${this.leaveIfSpent()} } else`;
    this.emit(
      `word ${value};`,
      `if (is_in(${address}, RAM, RAM_BYTES, ${bytes})) {`,
      `R(${register}) = ${value} = ${content};`,
      `} else if (is_in(${address}, FLASH, FLASH_BYTES, ${bytes})) {`,
      `R(${register}) = ${value} = ${content};`,
      `left -= wait(m, ${address} >> ${LINE_SHIFT}); ${this.leaveIfSpent()}`,
      `} else ${near} { ${this.leave()} }`,
    );
    this.known.set(register, value);
  }

  store(register, sum, bytes) {
    const value = this.get(register), address = this.keep(sum);
    const near = bytes !== WORD ? '' : `if (is_near(${address})) {`
      + ` store_near(m, ${address}, ${value}); left += 1; } else`;
    this.emit(
      `if (is_in(${address}, RAM, RAM_BYTES, ${bytes}) && !is_in_code(m, ${address})) {`,
      `${AT[bytes]}(${address}) = ${value};`,
      `} else ${near} { ${this.leave()} }`,
    );
  }

  literal() {
    const address = ((this.pc + 4) & ~3) + (this.eight << 2);
    this.set(this.d8, `WORD(${hex(address)})`);
    if (!this.isInFlash) return;
    this.emit(`left -= wait(m, ${hex(address >>> LINE_SHIFT)}); ${this.leaveIfSpent()}`);
  }

  // Many registers at once. The address must be in RAM, with room for them.

  need(address, isAligned) {
    const unaligned = isAligned ? ` || ${address} & 3` : '';
    this.emit(`if (${address} - RAM > RAM_BYTES - STACK_ROOM${unaligned}) { ${this.leave()} }`);
  }

  needNoCode(address) {
    this.emit(`if (may_be_in_code(m, ${address})) { ${this.leave()} }`);
  }

  storeAll(registers, address) {
    for (const [index, register] of registers.entries()) {
      this.emit(`WORD(${address} + ${4 * index}) = ${this.get(register)};`);
    }
  }

  loadAll(registers, address) {
    for (const [index, register] of registers.entries()) {
      this.set(register, `WORD(${address} + ${4 * index})`);
    }
  }

  push() {
    const list = this.op & 0x100 ? [...this.list, LR] : this.list;
    const bottom = this.keep(`${this.get(SP)} - ${4 * list.length}`);
    this.need(bottom, false);
    this.needNoCode(bottom);
    this.storeAll(list, bottom);
    this.set(SP, bottom);
    this.emit(`if (${bottom} < WORD(LOWEST)) WORD(LOWEST) = ${bottom};`);
  }

  pop() {
    const { list } = this, from = this.get(SP);
    this.need(from, false);
    this.loadAll(list, from);
    this.set(SP, `${from} + ${4 * list.length}`);
  }

  popWithPc() {
    const { list } = this, from = this.get(SP);
    this.need(from, false);
    const target = this.keep(`WORD(${from} + ${4 * list.length})`);
    this.needNoException(target);
    this.loadAll(list, from);
    this.set(SP, `${from} + ${4 * list.length + 4}`);
    this.jumpTo(target);
  }

  storeMany() {
    const { d8, list } = this, to = this.get(d8);
    this.need(to, true);
    this.needNoCode(to);
    this.storeAll(list, to);
    this.set(d8, `${to} + ${4 * list.length}`);
  }

  loadMany() {
    const { d8, list } = this, from = this.get(d8);
    this.need(from, true);
    this.loadAll(list, from);
    if (!list.includes(d8)) this.set(d8, `${from} + ${4 * list.length}`);
  }

  // Arithmetic

  plus(to, one, other) {
    this.addition(one, other, this.set(to, `${one} + ${other}`));
  }

  minus(to, one, other) {
    this.difference(one, other, this.set(to, `${one} - ${other}`));
  }

  compare(one, other) {
    this.difference(one, other, this.keep(`${one} - ${other}`));
  }

  plusCarry(one, other) {
    const partly = this.keep(`${one} + ${other}`);
    const sum = this.set(this.d, `${partly} + (${this.flags.c})`);
    const c = this.keep(`(word)(${partly} < ${one}) | (word)(${sum} < ${partly})`);
    this.addition(one, other, sum, c);
  }

  // Shifts by the lowest byte of a register.
  shift(result, carry) {
    const count = this.keep(`${this.get(this.n)} & 0xff`), value = this.get(this.d);
    const c = this.keep(`${count} ? ${carry(value, count)} : (${this.flags.c})`);
    this.sign(this.set(this.d, result(value, count)), c);
  }

  highResult(value) {
    if (this.high === PC) this.jumpTo(value);
    else this.set(this.high, this.high === SP ? `${value} & ~3u` : value);
  }

  branch() {
    const condition = (this.op >> 8) & 15;
    const compare = this.compared && COMPARISONS[condition];
    const isTaken = compare ? compare(...this.compared) : CONDITIONS[condition](this.flags);
    const target = this.next + 2 + ((this.op << 24) >> 23);
    this.emit(`if (${isTaken}) { ${this.jumping(target, 2)} }`);
  }

  wide() {
    const second = this.half(this.pc + 2);
    if (isBl(second)) {
      const sign = (this.op << 21) >> 31;
      const i1 = ~((second >> 13) ^ sign) & 1, i2 = ~((second >> 11) ^ sign) & 1;
      this.set(LR, hex(this.next | 1));
      this.jump(this.next + ((sign << 24) | (i1 << 23) | (i2 << 22) | ((this.op & 0x3ff) << 12)
        | ((second & 0x7ff) << 1)), this.cycles);
    } else if (this.op === MRS) {
      this.set((second >> 8) & 15, 'WORD(PRIMASK)');
    }
  }
}

// The instructions: pattern (letters are bits of operands), cycles, what they do; the first that
// fits counts. ENDS: the block ends with it. null: it is in no block. To the cycles of a list (r)
// comes one for each register.

const ENDS = true;
const sum = (b) => `${b.get(b.n)} + ${b.get(b.m)}`;
const beside = (b, offset) => `${b.get(b.n)} + ${offset}`;
const besideSp = (b) => `${b.get(SP)} + ${b.eight << 2}`;
const bit = (value, count) => `${value} >> ${count} & 1`;
const logical = (operation) => (b) =>
  b.sign(b.set(b.d, operation(b.get(b.d), b.get(b.n))));
const unary = (operation) => (b) => b.set(b.d, operation(b.get(b.n)));

export const ROWS = [
  ['00000iiiiinnnddd', 1, (b) => { // LSLS
    const value = b.get(b.n), count = b.five;
    b.sign(b.set(b.d, `${value} << ${count}`), count ? bit(value, 32 - count) : b.flags.c);
  }],
  ['00001iiiiinnnddd', 1, (b) => { // LSRS
    const value = b.get(b.n), count = b.five;
    b.sign(b.set(b.d, count ? `${value} >> ${count}` : '0'), bit(value, (count - 1) & 31));
  }],
  ['00010iiiiinnnddd', 1, (b) => { // ASRS
    const value = b.get(b.n), count = b.five;
    b.sign(b.set(b.d, `(number)${value} >> ${count || 31}`), bit(value, (count - 1) & 31));
  }],
  ['0001100mmmnnnddd', 1, (b) => b.plus(b.d, b.get(b.n), b.get(b.m))],
  ['0001101mmmnnnddd', 1, (b) => b.minus(b.d, b.get(b.n), b.get(b.m))],
  ['0001110iiinnnddd', 1, (b) => b.plus(b.d, b.get(b.n), hex(b.m))],
  ['0001111iiinnnddd', 1, (b) => b.minus(b.d, b.get(b.n), hex(b.m))],
  ['00100dddiiiiiiii', 1, (b) => b.sign(b.set(b.d8, hex(b.eight)))],
  ['00101nnniiiiiiii', 1, (b) => b.compare(b.get(b.d8), hex(b.eight))],
  ['00110dddiiiiiiii', 1, (b) => b.plus(b.d8, b.get(b.d8), hex(b.eight))],
  ['00111dddiiiiiiii', 1, (b) => b.minus(b.d8, b.get(b.d8), hex(b.eight))],
  ['0100000000nnnddd', 1, logical((one, other) => `${one} & ${other}`)],
  ['0100000001nnnddd', 1, logical((one, other) => `${one} ^ ${other}`)],
  ['0100000010nnnddd', 1, (b) => b.shift( // LSLS
    (value, count) => `${count} < 32 ? ${value} << ${count} : 0`,
    (value, count) => `(${count} <= 32 ? ${value} >> (32 - ${count}) & 1 : 0)`)],
  ['0100000011nnnddd', 1, (b) => b.shift( // LSRS
    (value, count) => `${count} < 32 ? ${value} >> ${count} : 0`,
    (value, count) => `(${count} <= 32 ? ${value} >> (${count} - 1) & 1 : 0)`)],
  ['0100000100nnnddd', 1, (b) => b.shift( // ASRS
    (value, count) => `(number)${value} >> (${count} < 32 ? ${count} : 31)`,
    (value, count) => `((number)${value} >> (${count} < 32 ? ${count} - 1 : 31) & 1)`)],
  ['0100000101nnnddd', 1, (b) => b.plusCarry(b.get(b.d), b.get(b.n))], // ADCS
  ['0100000110nnnddd', 1, (b) => b.plusCarry(b.get(b.d), b.keep(`~${b.get(b.n)}`))], // SBCS
  ['0100000111nnnddd', 1, (b) => b.shift( // RORS
    (value, count) => `rotated(${value}, ${count})`,
    (value, count) => `rotated(${value}, ${count}) >> 31`)],
  ['0100001000nnnddd', 1, (b) => b.sign(b.keep(`${b.get(b.d)} & ${b.get(b.n)}`))], // TST
  ['0100001001nnnddd', 1, (b) => b.minus(b.d, hex(0), b.get(b.n))], // RSBS
  ['0100001010nnnddd', 1, (b) => b.compare(b.get(b.d), b.get(b.n))],
  ['0100001011nnnddd', 1, (b) => { // CMN
    const one = b.get(b.d), other = b.get(b.n);
    b.addition(one, other, b.keep(`${one} + ${other}`));
  }],
  ['0100001100nnnddd', 1, logical((one, other) => `${one} | ${other}`)],
  ['0100001101nnnddd', 1, logical((one, other) => `${one} * ${other}`)],
  ['0100001110nnnddd', 1, logical((one, other) => `${one} & ~${other}`)],
  ['0100001111nnnddd', 1, (b) => b.sign(b.set(b.d, `~${b.get(b.n)}`))], // MVNS
  ['010001001nnnn111', 2, (b) => b.highResult(`(${b.get(b.high)} + ${b.get(b.anyN)})`), ENDS],
  ['01000100dnnnnddd', 1, (b) => b.highResult(`(${b.get(b.high)} + ${b.get(b.anyN)})`)],
  ['01000101dnnnnddd', 1, (b) => b.compare(b.get(b.high), b.get(b.anyN))],
  ['010001101nnnn111', 2, (b) => b.highResult(b.get(b.anyN)), ENDS],
  ['01000110dnnnnddd', 1, (b) => b.highResult(b.get(b.anyN))],
  ['01000111l1111000', 0, null], // BX and BLX of PC, which no compiler writes
  ['010001110nnnn000', 2, (b) => { // BX
    b.needNoException(b.get(b.anyN));
    b.jumpTo(b.get(b.anyN));
  }, ENDS],
  ['010001111nnnn000', 2, (b) => { // BLX
    const target = b.get(b.anyN);
    b.set(LR, hex(b.next | 1));
    b.jumpTo(target);
  }, ENDS],
  ['01001dddiiiiiiii', 2, (b) => b.literal()],
  ['0101000mmmnnnddd', 2, (b) => b.store(b.d, sum(b), WORD)],
  ['0101001mmmnnnddd', 2, (b) => b.store(b.d, sum(b), HALF)],
  ['0101010mmmnnnddd', 2, (b) => b.store(b.d, sum(b), BYTE)],
  ['0101011mmmnnnddd', 2, (b) => b.load(b.d, sum(b), BYTE, true)],
  ['0101100mmmnnnddd', 2, (b) => b.load(b.d, sum(b), WORD)],
  ['0101101mmmnnnddd', 2, (b) => b.load(b.d, sum(b), HALF)],
  ['0101110mmmnnnddd', 2, (b) => b.load(b.d, sum(b), BYTE)],
  ['0101111mmmnnnddd', 2, (b) => b.load(b.d, sum(b), HALF, true)],
  ['01100iiiiinnnddd', 2, (b) => b.store(b.d, beside(b, b.five << 2), WORD)],
  ['01101iiiiinnnddd', 2, (b) => b.load(b.d, beside(b, b.five << 2), WORD)],
  ['01110iiiiinnnddd', 2, (b) => b.store(b.d, beside(b, b.five), BYTE)],
  ['01111iiiiinnnddd', 2, (b) => b.load(b.d, beside(b, b.five), BYTE)],
  ['10000iiiiinnnddd', 2, (b) => b.store(b.d, beside(b, b.five << 1), HALF)],
  ['10001iiiiinnnddd', 2, (b) => b.load(b.d, beside(b, b.five << 1), HALF)],
  ['10010dddiiiiiiii', 2, (b) => b.store(b.d8, besideSp(b), WORD)],
  ['10011dddiiiiiiii', 2, (b) => b.load(b.d8, besideSp(b), WORD)],
  ['10100dddiiiiiiii', 1, (b) => b.set(b.d8, hex(((b.pc + 4) & ~3) + (b.eight << 2)))], // ADR
  ['10101dddiiiiiiii', 1, (b) => b.set(b.d8, besideSp(b))],
  ['101100000iiiiiii', 1, (b) => b.set(SP, `${b.get(SP)} + ${b.seven << 2}`)],
  ['101100001iiiiiii', 1, (b) => b.set(SP, `${b.get(SP)} - ${b.seven << 2}`)],
  ['1011001000nnnddd', 1, unary((value) => `(number)(int16_t)${value}`)], // SXTH
  ['1011001001nnnddd', 1, unary((value) => `(number)(int8_t)${value}`)],
  ['1011001010nnnddd', 1, unary((value) => `(uint16_t)${value}`)],
  ['1011001011nnnddd', 1, unary((value) => `(uint8_t)${value}`)],
  ['1011010rrrrrrrrr', 1, (b) => b.push()],
  ['1011011001110010', 1, (b) => b.emit('WORD(PRIMASK) = 1;')], // CPSID
  ['1011101000nnnddd', 1, unary((value) => `__builtin_bswap32(${value})`)], // REV
  ['10111100rrrrrrrr', 1, (b) => b.pop()],
  ['10111101rrrrrrrr', 3, (b) => b.popWithPc(), ENDS],
  ['1011111100000000', 1, () => {}], // NOP
  ['11000nnnrrrrrrrr', 1, (b) => b.storeMany()],
  ['11001nnnrrrrrrrr', 1, (b) => b.loadMany()],
  ['1101111iiiiiiiii', 0, null], // UDF and SVC, which are no branches
  ['1101cccciiiiiiii', 1, (b) => b.branch()],
  ['11100iiiiiiiiiii', 2, (b) => b.jump(b.next + 2 + ((b.op << 21) >> 20), b.cycles), ENDS],
  ['11110iiiiiiiiiii', 3, (b) => b.wide()],
].map(([pattern, cycles, does, ends = false]) => ({
  mask: parseInt(pattern.replace(/[01]/g, '1').replace(/[a-z]/g, '0'), 2),
  value: parseInt(pattern.replace(/[a-z]/g, '0'), 2),
  hasList: pattern.includes('r'), cycles, does, ends,
}));

// When BEQ and its like are taken: by the flags, and by the two that were compared.
const CONDITIONS = [
  ({ z }) => `${z} == 0`,
  ({ z }) => `${z} != 0`,
  ({ c }) => c,
  ({ c }) => `!(${c})`,
  ({ n }) => `(number)${n} < 0`,
  ({ n }) => `(number)${n} >= 0`,
  ({ v }) => v,
  ({ v }) => `!(${v})`,
  ({ c, z }) => `(${c}) && ${z} != 0`,
  ({ c, z }) => `!(${c}) || ${z} == 0`,
  ({ n, v }) => `${n} >> 31 == (${v})`,
  ({ n, v }) => `${n} >> 31 != (${v})`,
  ({ n, z, v }) => `${z} != 0 && ${n} >> 31 == (${v})`,
  ({ n, z, v }) => `${z} == 0 || ${n} >> 31 != (${v})`,
];
const signed = (operator) => (one, other) => `(number)${one} ${operator} (number)${other}`;
const COMPARISONS = {
  8: (one, other) => `${one} > ${other}`, 9: (one, other) => `${one} <= ${other}`,
  10: signed('>='), 11: signed('<'), 12: signed('>'), 13: signed('<='),
};

const WIDE = 0b11110, MRS = 0xf3ef, MRS_OF_PRIMASK = 0x8010, BARRIER = 0xf3bf;
const isBl = (second) => (second & 0xd000) === 0xd000;

// Whether the wide instruction can be in a block.
function isUsual(op, second) {
  return isBl(second) || (op === MRS && (second & 0xf0ff) === MRS_OF_PRIMASK)
    || (op === BARRIER && second >= 0x8f40 && second < 0x8f70);
}

function bits(list) {
  let count = 0;
  for (let rest = list; rest; rest &= rest - 1) count++;
  return count;
}

// [{ op, bytes, cycles, does, ends }], up to what is no part of a block.
function decode(start, half) {
  const found = [];
  for (let at = start; found.length < MOST;) {
    const op = half(at);
    const row = op === undefined ? null : ROWS.find(({ mask, value }) => (op & mask) === value);
    if (!row?.does) break;
    const { does, hasList } = row, isWide = op >> 11 === WIDE;
    const second = isWide ? half(at + 2) : 0;
    if (isWide && !isUsual(op, second)) break;
    const cycles = row.cycles + (hasList ? bits(op & 0xff) : 0);
    const bytes = isWide ? 4 : 2, ends = row.ends || (isWide && isBl(second));
    found.push({ op, bytes, cycles, does, ends });
    if (ends) break;
    at += bytes;
  }
  return found;
}
