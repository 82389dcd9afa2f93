// One instruction for each operation; several for exp and for the inverse root.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/formulas/code_steps.hpp>
#include <boltzmann/formulas/machine_code.hpp>

#include <algorithm>
#include <utility>

#if defined(__x86_64__)
namespace boltzmann::code {

bool is_plain(Step const& step) {
  if (step.instruction != Instruction::function) return true;
  switch (step.operation) {
    case Operation::exp:
    case Operation::abs:
    case Operation::floor:
    case Operation::min:
    case Operation::max:
    case Operation::less:
    case Operation::less_equal:
    case Operation::equal:
    case Operation::select:
      return true;
    default:
      return false;
  }
}
bool are_plain(std::vector<Step> const& steps) { return std::all_of(steps.begin(), steps.end(), is_plain); }

void Steps::keep_numbers(std::vector<Step> const& steps, std::size_t first, std::size_t end) {
  for (std::size_t k = first; k < end; ++k) {
    auto const& step = steps[k];
    if (step.instruction == Instruction::reciprocal) keep(Number::one, Number::one);
    if (step.instruction == Instruction::inverse_root) keep(Number::one, Number::five_sixteenths);
    if (step.instruction == Instruction::function && step.operation == Operation::exp)
      keep(Number::log2_e, Number::roots_high);
  }
}

void Steps::sequence(std::vector<Step> const& steps, std::size_t first, std::size_t end, bool keep) {
  for (std::size_t k = first; k < end; ++k) {
    at_ = k;
    pinned_.fill(false);
    step(steps[k], flow_->steps[k]);
    auto const& of = flow_->steps[k];
    for (int const read : {of.a, of.b, of.c})
      if (read >= 0 && value(read).in_register >= 0 && value(read).read_after(k) == 0) forget(value(read).in_register);
    Kept& result = value(of.to);
    if (!keep || !result.is_wanted(end) || result.in_column) continue;
    vmovapd(column(result.column), reg(result.in_register));
    result.in_column = true;
  }
}

void Steps::step(Step const& step, Flow::Of const& of) {
  Source const a = source(step.a, of.a), b = source(step.b, of.b), c = source(step.c, of.c);
  switch (step.instruction) {
    case Instruction::add:
      return either_way(a, b, of.to, [&](Xmm to, Xmm x, auto const& y) { vaddpd(to, x, y); });
    case Instruction::multiply:
      return either_way(a, b, of.to, [&](Xmm to, Xmm x, auto const& y) { vmulpd(to, x, y); });
    case Instruction::subtract:
      return two(a, b, of.to, [&](Xmm to, Xmm x, auto const& y) { vsubpd(to, x, y); });
    case Instruction::multiply3: {
      int const to = take();
      Xmm const x = in(a);
      with(b, [&](auto const& y) { vmulpd(reg(to), x, y); });
      with(c, [&](auto const& y) { vmulpd(reg(to), reg(to), y); });
      return hold(to, of.to);
    }
    case Instruction::fuse:
      return fuse(a, b, c, of.to);
    case Instruction::reciprocal:
      return reciprocal(a, of.to);
    case Instruction::root:
      return one(a, of.to, [&](Xmm to, auto const& x) { vsqrtpd(to, x); });
    case Instruction::inverse_root:
      return inverse_root(a, of.to);
    case Instruction::function:
      return operation(step.operation, a, b, c, of.to);
  }
}

template <class F>
void Steps::one(Source const& a, int to, F const& f) {
  with(a, [&](auto const& x) {
    int const r = result_beside(a, {-1, 0});
    f(reg(r), x);
    hold(r, to);
  });
}

template <class F>
void Steps::two(Source const& a, Source const& b, int to, F const& f) {
  Xmm const x = in(a);
  with(b, [&](auto const& y) {
    int const r = result_beside(a, b);
    f(reg(r), x, y);
    hold(r, to);
  });
}

template <class F>
void Steps::either_way(Source const& a, Source const& b, int to, F const& f) {
  if (in_register(b) && !in_register(a)) return two(b, a, to, f);
  if (a.value < 0 && b.value >= 0) return two(b, a, to, f);
  two(a, b, to, f);
}

int Steps::result_beside(Source const& a, Source const& b) {
  for (auto const& of : {a, b}) {
    if (!in_register(of) || !ends(of)) continue;
    int const r = value(of.value).in_register;
    forget(r);
    return r;
  }
  return take();
}

void Steps::fuse(Source a, Source b, Source const& c, int to) {
  if (in_register(c) && ends(c)) {
    if (a.value < 0 && b.value >= 0) std::swap(a, b);
    int const r = value(c.value).in_register;
    pin(r);
    Xmm const x = in(a);
    with(b, [&](auto const& y) { vfmadd231pd(reg(r), x, y); });
    forget(r);
    return hold(r, to);
  }
  if (!(in_register(a) && ends(a)) && in_register(b) && ends(b)) std::swap(a, b);
  if (in_register(a) && ends(a)) {
    int const r = value(a.value).in_register;
    pin(r);
    Xmm const x = in(b);
    with(c, [&](auto const& y) { vfmadd213pd(reg(r), x, y); });
    forget(r);
    return hold(r, to);
  }
  if (a.value < 0 && b.value >= 0) std::swap(a, b);
  Xmm const x = in(a);
  int const r = take();
  with(c, [&](auto const& y) { vmovapd(reg(r), y); });
  with(b, [&](auto const& y) { vfmadd231pd(reg(r), x, y); });
  hold(r, to);
}

void Steps::reciprocal(Source const& a, int to) {
  int const r = take();
  Xmm const one = kept(Number::one, reg(r));
  with(a, [&](auto const& x) { vdivpd(reg(r), one, x); });
  hold(r, to);
}

void Steps::inverse_root(Source const& a, int to) {
  int const r = take();
  if (width_ == 4) {
    int const root = take();
    with(a, [&](auto const& x) { vsqrtpd(reg(root), x); });
    vdivpd(reg(r), kept(Number::one, reg(r)), reg(root));
    return hold(r, to);
  }
  Xmm const x = in(a), y = reg(r), e = reg(take()), p = reg(take());
  vrsqrt14pd(y, x);
  vmulpd(e, x, y);
  vfnmadd213pd(e, y, number(Number::one));
  vmovapd(p, number(Number::five_sixteenths));
  vfmadd213pd(p, e, number(Number::three_eighths));
  vfmadd213pd(p, e, number(Number::half));
  vcmppd(k1, e, e, 0);
  vmulpd(e, y, e);
  vfmadd231pd(y | k1, e, p);
  hold(r, to);
}

void Steps::exponential(Source const& a, int to) {
  Xmm const given = in(a);
  int const r = take();
  Xmm const result = reg(r), shifted = reg(take()), k = reg(take()), rest = reg(take());
  Xmm root = shifted;
  if (width_ == 4) {
    vmovapd(rest, number(Number::over));
    vminpd(rest, rest, given);
    root = reg(take());
    vmovapd(root, number(Number::under));
    vmaxpd(rest, root, rest);
  }
  Xmm const x = width_ == 4 ? rest : given;
  vmovapd(shifted, number(Number::to_sixteenths));
  vfmadd231pd(shifted, x, number(Number::log2_e));
  vsubpd(k, shifted, number(Number::to_sixteenths));
  if (width_ == 8) {
    vcmppd(k1, given, number(Number::least_exponent), 5);  // not below it
    vmovapd(rest, given);
  }
  vfnmadd231pd(rest, k, number(Number::ln2_high));
  vfnmadd231pd(rest, k, number(Number::ln2_low));
  if (width_ == 8) {
    vpermi2pd(root, kept(Number::roots_low, result), number(Number::roots_high));
  } else {
    vandpd(result, shifted, number(Number::fifteen));
    lea(r9, number_memory_[static_cast<std::size_t>(Number::roots_low)]);
    vpcmpeqd(half_reg(k.getIdx()), half_reg(k.getIdx()), half_reg(k.getIdx()));
    vgatherqpd(half_reg(root.getIdx()), ptr[r9 + half_reg(r) * 8], half_reg(k.getIdx()));
  }
  Xmm const square = reg(take()), more = reg(take());
  vmulpd(square, rest, rest);
  vmovapd(result, number(Number::c0));
  vfmadd231pd(result, rest, number(Number::c1));
  vmovapd(more, number(Number::c2));
  vfmadd231pd(more, rest, number(Number::c3));
  vfmadd231pd(more, square, number(Number::c4));
  vfmadd231pd(result, square, more);
  vfmadd213pd(result, square, rest);
  vfmadd213pd(result, root, root);
  if (width_ == 8) {
    vscalefpd(result | k1 | T_z, result, k);
  } else {  // times 2^n in two factors
    auto const whole = half_reg(shifted.getIdx()), first = half_reg(k.getIdx());
    vpsrlq(whole, whole, 4);
    vpaddq(whole, whole, number(Number::bias));
    vpsrlq(first, whole, 1);
    vpsubq(whole, whole, first);
    vpsllq(first, first, 52);
    vpsllq(whole, whole, 52);
    vmulpd(result, result, first);
    vmulpd(result, result, whole);
  }
  hold(r, to);
}

void Steps::operation(Operation operation, Source const& a, Source const& b, Source const& c, int to) {
  switch (operation) {
    case Operation::exp:
      return exponential(a, to);
    case Operation::abs: {
      int const r = take();
      vmovapd(reg(r), number(Number::sign_free));
      with(a, [&](auto const& x) { vandpd(reg(r), reg(r), x); });
      return hold(r, to);
    }
    case Operation::floor:
      return one(a, to, [&](Xmm r, auto const& x) { width_ == 8 ? vrndscalepd(r, x, 9) : vroundpd(r, x, 9); });
    case Operation::min:  // returns the second operand if one is NaN
      return two(b, a, to, [&](Xmm r, Xmm x, auto const& y) { vminpd(r, x, y); });
    case Operation::max:
      return two(b, a, to, [&](Xmm r, Xmm x, auto const& y) { vmaxpd(r, x, y); });
    case Operation::less:
      return compare(a, b, to, 1);
    case Operation::less_equal:
      return compare(a, b, to, 2);
    case Operation::equal:
      return compare(a, b, to, 0);
    case Operation::select: {
      int const r = take();
      Xmm const x = in(a), y = in(b), z = in(c);
      vxorpd(reg(r), reg(r), reg(r));
      if (width_ == 8) {
        vcmppd(k1, x, reg(r), 4);
        vblendmpd(reg(r) | k1, z, y);
      } else {
        vcmppd(reg(r), x, reg(r), 4);
        vblendvpd(reg(r), z, y, reg(r));
      }
      return hold(r, to);
    }
    default:
      throw Error("an instruction that there is not");
  }
}

void Steps::compare(Source const& a, Source const& b, int to, std::uint8_t how) {
  two(a, b, to, [&](Xmm r, Xmm x, auto const& y) {
    if (width_ == 8) {
      vcmppd(k1, x, y, how);
      vmovapd(r | k1 | T_z, number(Number::one));
    } else {
      vcmppd(r, x, y, how);
      vandpd(r, r, number(Number::one));
    }
  });
}

}  // namespace boltzmann::code
#endif
