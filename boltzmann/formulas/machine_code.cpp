// The functions that machine code consists of: the loop over packs, a row's scalars, and the whole pass over a row of a
// neighbour list.
#include <boltzmann/core/error.hpp>
#include <boltzmann/formulas/code_steps.hpp>
#include <boltzmann/formulas/machine_code.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace boltzmann {

#if defined(__x86_64__)
namespace {

using namespace code;

class CodeWriter : public MachineCode, private Steps {
 public:
  CodeWriter(FormulaProgram const& program, int width, std::optional<GatheredColumns> const& gathered)
      : Steps(32768 + 1024 * (program.steps.size() + program.row_steps.size()), width,
              gathered ? gathered->least_square : least_square) {
    // Labels must be defined before a list that is generated several times. After the code, constants are read faster
    // on AVX-512, by a seventh of Morse's pass.
    if (width_ == 4) number_packs();
    auto const& steps = program.steps;
    Flow flow(steps, program.columns);
    for (auto const result : program.results) flow.read(result, never);
    for (auto& value : flow.values) value.in_column = true;  // except those that steps write
    for (auto const& of : flow.steps) flow.values[static_cast<std::size_t>(of.to)].in_column = false;
    flow_ = &flow;
    std::vector<std::size_t> begins;
    for (std::size_t k = 0; k < steps.size();) {
      std::size_t end = k + 1;
      while (end < steps.size() && is_plain(steps[end]) == is_plain(steps[k])) ++end;
      pieces_.push_back({nullptr, k, end - k});
      begins.push_back(never);
      if (is_plain(steps[k])) {
        begins.back() = getSize();
        block(steps, k, end);
      } else {
        for (std::size_t j = k; j < end; ++j) value(flow.steps[j].to).in_column = true;
      }
      k = end;
    }
    std::size_t const row_begin = getSize();
    bool const has_row = !program.row_steps.empty() && are_plain(program.row_steps);
    if (has_row) row(program);
    std::size_t const list_begin = getSize();
    bool const has_list = gathered && are_plain(steps) && can_gather(*gathered);
    if (has_list) list_with_numbers(program, *gathered);
    if (width_ == 8) number_packs();
    setProtectModeRE();
    auto* const code = const_cast<std::uint8_t*>(getCode());  // a pointer to a function has no const
    for (std::size_t k = 0; k < pieces_.size(); ++k)
      if (begins[k] != never) pieces_[k].function = reinterpret_cast<Block>(code + begins[k]);
    if (has_row) row_ = reinterpret_cast<Row>(code + row_begin);
    if (has_list) list_ = reinterpret_cast<List>(code + list_begin);
  }

 private:
  // ---- Functions ----

  void block(std::vector<Step> const& steps, std::size_t first, std::size_t end) {
    begin(*flow_, rdi + rax, static_cast<int>(block_pairs * sizeof(double)), rsi);
    Xbyak::Label loop, done;
    shl(rdx, width_ == 8 ? 6 : 5);
    jz(done, T_NEAR);
    xor_(eax, eax);
    keep_numbers(steps, first, end);
    keep_scalars(steps, first, end);
    align(16);
    L(loop);
    sequence(steps, first, end, true);
    for (int r = 0; r < registers_; ++r) forget(r);
    add(rax, bytes());
    cmp(rax, rdx);
    jb(loop, T_NEAR);
    L(done);
    vzeroupper();
    ret();
  }

  /// Scalars are columns of one pack here.
  void row(FormulaProgram const& program) {
    std::vector<Step> steps = program.row_steps;
    for (auto& step : steps)
      for (auto* operand : {&step.to, &step.a, &step.b, &step.c}) operand->scalar = false;
    Flow flow(steps, program.scalars);
    for (auto& value : flow.values) value.in_column = true;
    for (auto const& of : flow.steps) {
      auto& result = flow.values[static_cast<std::size_t>(of.to)];
      result.in_column = false;
      result.reads.push_back(never);
    }
    begin(flow, Xbyak::RegExp(rdi), bytes(), rsi);
    sequence(steps, 0, steps.size(), true);
    vzeroupper();
    ret();
  }

  static constexpr std::size_t quad = 4;  // doubles in a block of a row
  static std::vector<int> blocks_of(GatheredColumns const& gathered) {
    std::vector<int> blocks{0};
    for (int const field : gathered.fields)
      if (field / static_cast<int>(quad) != blocks.back()) blocks.push_back(field / static_cast<int>(quad));
    return blocks;
  }
  /// Blocks after the first one have a register each.
  static bool can_gather(GatheredColumns const& gathered) {
    return gathered.dimension < static_cast<int>(quad) && blocks_of(gathered).size() <= 3;
  }

  /// Uses as few registers for values as possible. The others hold constants and scalars, which a loop would otherwise
  /// reload for each pack.
  void list_with_numbers(FormulaProgram const& program, GatheredColumns const& gathered) {
    std::size_t const begin = getSize();
    for (for_values_ = width_ == 8 ? usual_for_values : fewest_for_values;; ++for_values_) {
      setSize(begin);
      to_columns_ = 0;
      list(program, gathered);
      if (to_columns_ == 0 || for_values_ >= usual_for_values) break;
    }
  }

  void list(FormulaProgram const& program, GatheredColumns const& gathered) {
    int const D = gathered.dimension;
    std::size_t const end = program.steps.size();
    Flow flow(program.steps, program.columns);
    auto const input = [](int which) { return Operand{static_cast<std::uint16_t>(which), false}; };
    for (auto const result : program.results) flow.read(result, end);
    if (gathered.along)
      for (int c = 0; c < D; ++c) flow.read(input(c), end);
    if (width_ == 4) flow.read(input(D), end);  // for the mask
    begin(flow, Xbyak::RegExp(r8), static_cast<int>(block_pairs * sizeof(double)), rcx);
    registers_ -= D;
    auto const sum = [this, first = registers_](int c) { return reg(first + c); };

    auto const blocks = blocks_of(gathered);
    Xbyak::Reg64 const base[3] = {rdx, r10, r11};
    for (std::size_t b = 1; b < blocks.size(); ++b) {
      imul(base[b], r9, blocks[b]);
      add(base[b], rdx);
    }
    for (int c = 0; c < D; ++c) vxorpd(sum(c), sum(c), sum(c));
    Xbyak::Label loop, done;
    cmp(rdi, rsi);
    jae(done, T_NEAR);
    keep_numbers(program.steps, 0, end);
    keep(Number::least_square, Number::least_square);
    keep_scalars(program.steps, 0, end);
    align(16);
    L(loop);
    at_ = 0;
    pinned_.fill(false);
    separation(program, gathered);
    for (std::size_t b = 1; b < blocks.size(); ++b) gather(base[b], fields_in(blocks[b], gathered));
    add(rdi, 4 * width_);
    sequence(program.steps, 0, end, false);
    at_ = end;
    pinned_.fill(false);
    add_up(program, gathered, sum);
    for (int r = 0; r < registers_; ++r) forget(r);
    cmp(rdi, rsi);
    jb(loop, T_NEAR);
    L(done);
    for (int c = 0; c < D; ++c) vmovapd(column(static_cast<std::uint16_t>(c)), sum(c));
    vzeroupper();
    ret();
  }

  /// Loads four columns of the rows of the entries at rdi, into registers of their own; -1 for those that are not
  /// wanted.
  std::array<int, quad> transposed(Xbyak::Reg64 const& rows, std::array<bool, quad> const& wanted) {
    int r[6];
    for (auto& each : r) each = take();
    auto const row_of = [&](int lane) {
      mov(eax, dword[rdi + 4 * lane]);
      return ptr[rows + rax * 8];
    };
    if (width_ == 8) {
      constexpr int low[] = {0, 1, 4, 5}, high[] = {2, 3, 6, 7};
      for (int k = 0; k < 4; ++k) {
        vmovapd(half_reg(r[k]), row_of(low[k]));
        vinsertf64x4(Xbyak::Zmm(r[k]), Xbyak::Zmm(r[k]), row_of(high[k]), 1);
      }
    } else {
      for (int k = 0; k < 4; ++k) vmovapd(reg(r[k]), row_of(k));
    }
    auto const joined = [&](int to, int a, int b, bool second) {
      if (width_ == 8)
        vshuff64x2(Xbyak::Zmm(to), Xbyak::Zmm(a), Xbyak::Zmm(b), second ? 0xDD : 0x88);
      else
        vperm2f128(half_reg(to), half_reg(a), half_reg(b), second ? 0x31 : 0x20);
      return to;
    };
    std::array<int, quad> result{-1, -1, -1, -1};
    bool const even = wanted[0] || wanted[2], odd = wanted[1] || wanted[3];
    if (even) vunpcklpd(reg(r[4]), reg(r[0]), reg(r[1])), vunpcklpd(reg(r[5]), reg(r[2]), reg(r[3]));
    if (odd) vunpckhpd(reg(r[0]), reg(r[0]), reg(r[1])), vunpckhpd(reg(r[2]), reg(r[2]), reg(r[3]));
    if (wanted[0]) result[0] = joined(r[1], r[4], r[5], false);
    if (wanted[2]) result[2] = joined(r[4], r[4], r[5], true);
    if (wanted[1]) result[1] = joined(r[3], r[0], r[2], false);
    if (wanted[3]) result[3] = joined(r[0], r[0], r[2], true);
    for (int const each : r)
      pinned_[static_cast<std::size_t>(each)] = std::find(result.begin(), result.end(), each) != result.end();
    return result;
  }
  /// The value of a column from here on, if it is used.
  void settle(int r, int which) {
    pinned_[static_cast<std::size_t>(r)] = false;
    if (which >= 0) hold(r, which);
  }
  /// The fields in this block of a row; -1: not read.
  std::array<int, quad> fields_in(int block, GatheredColumns const& gathered) const {
    std::array<int, quad> columns{-1, -1, -1, -1};
    for (std::size_t f = 0; f < gathered.fields.size(); ++f)
      if (gathered.fields[f] / static_cast<int>(quad) == block)
        columns[static_cast<std::size_t>(gathered.fields[f]) % quad] =
            flow_->at[static_cast<std::size_t>(gathered.dimension) + 1 + f];
    return columns;
  }
  void gather(Xbyak::Reg64 const& rows, std::array<int, quad> const& columns) {
    std::array<bool, quad> wanted{};
    for (std::size_t k = 0; k < quad; ++k) wanted[k] = columns[k] >= 0;
    auto const r = transposed(rows, wanted);
    for (std::size_t k = 0; k < quad; ++k)
      if (wanted[k]) settle(r[k], columns[k]);
  }
  /// q.position - p.position and its square, and the fields that follow q's position.
  void separation(FormulaProgram const& program, GatheredColumns const& gathered) {
    std::size_t const D = static_cast<std::size_t>(gathered.dimension);
    auto const fields = fields_in(0, gathered);
    std::array<bool, quad> wanted{};
    for (std::size_t k = 0; k < quad; ++k) wanted[k] = k < D || fields[k] >= 0;
    auto const r = transposed(rdx, wanted);
    for (std::size_t k = D; k < quad; ++k)
      if (wanted[k]) settle(r[k], fields[k]);
    int const square = take();
    for (std::size_t c = 0; c < D; ++c) {
      Xmm const d = reg(r[c]);
      vsubpd(d, d, scalar(program.scalars + c));
      if (c == 0)
        vmulpd(reg(square), d, d);
      else
        vfmadd231pd(reg(square), d, d);
    }
    int const least = take();
    vmaxpd(reg(square), kept(Number::least_square, reg(least)), reg(square));
    pinned_[static_cast<std::size_t>(least)] = false;
    if (width_ == 8) vcmppd(k2, reg(square), scalar(program.scalars + D), 1);
    for (std::size_t c = 0; c < D; ++c) settle(r[c], flow_->at[c]);
    settle(square, flow_->at[D]);
  }
  /// Adds up the results of pairs within the cut-off.
  template <class Sum>
  void add_up(FormulaProgram const& program, GatheredColumns const& gathered, Sum const& sum) {
    std::size_t const D = static_cast<std::size_t>(gathered.dimension);
    auto const result = [&](std::size_t r) {
      Operand const operand = program.results[r];
      return source(operand, operand.scalar ? -1 : flow_->at[operand.index]);
    };
    std::optional<Xmm> factor;
    auto const in_sum = [&](std::size_t c) { return gathered.along ? Source{flow_->at[c], 0} : result(c); };
    if (width_ == 8) {
      if (gathered.along) factor = in(result(0));
      for (std::size_t c = 0; c < D; ++c)
        with(in_sum(c), [&](auto const& x) {
          Xmm const total = sum(static_cast<int>(c));
          gathered.along ? vfmadd231pd(total | k2, *factor, x) : vaddpd(total | k2, total, x);
        });
      return;
    }
    // Other lanes are zero.
    Xmm const mask = reg(take()), counted = reg(take());
    vcmppd(mask, in({flow_->at[D], 0}), scalar(program.scalars + D), 1);
    if (gathered.along) {
      factor = reg(take());
      with(result(0), [&](auto const& x) { vandpd(*factor, mask, x); });
    }
    for (std::size_t c = 0; c < D; ++c)
      with(in_sum(c), [&](auto const& x) {
        Xmm const total = sum(static_cast<int>(c));
        vandpd(counted, mask, x);
        gathered.along ? vfmadd231pd(total, *factor, counted) : vaddpd(total, total, counted);
      });
  }
};

bool processor_has(int width) {
  __builtin_cpu_init();
  if (width == 8) return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
  return width == 4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}

}  // namespace
#endif

namespace {
bool interpreted() {
  static bool const asked = [] {
    char const* const word = std::getenv("BOLTZMANN_FORMULAS");
    std::string_view const said = word ? word : "";
    if (!said.empty() && said != "interpreted" && said != "compiled")
      throw Error(fmt::format("BOLTZMANN_FORMULAS is '{}'; it may be interpreted or compiled", quoted(said)));
    return said == "interpreted";
  }();
  return asked;
}
}  // namespace

std::shared_ptr<MachineCode const> machine_code([[maybe_unused]] FormulaProgram const& program,
                                                [[maybe_unused]] int width,
                                                [[maybe_unused]] std::optional<GatheredColumns> const& gathered) {
  if (interpreted()) return nullptr;
#if defined(__x86_64__)
  if (!processor_has(width)) return nullptr;
  try {
    return std::make_shared<CodeWriter>(program, width, gathered);
  } catch (Xbyak::Error const&) {  // pages that may not be executed
    return nullptr;
  }
#else
  return nullptr;
#endif
}

}  // namespace boltzmann
