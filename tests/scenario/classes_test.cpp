// Classes that a scenario derives: their fields, their rates, and what changes these.
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include "mistakes.hpp"

#include <gtest/gtest.h>
#include <tests/same_rows.hpp>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

namespace boltzmann::classes_test {
namespace {

using test::ensemble;
using test::Mistake;
using test::mistake_name;
using test::replaced;

double number(AnyEnsemble const& particles, std::size_t i, char const* field, int component = 0) {
  return particles.row(i)[particles.field(field).offset + component];
}

// A mass on a spring from outside, x = cos t, and fields of every kind of rate.
std::string oscillator(std::string const& method, double step, std::string const& base = "Newton") {
  std::string const moved = base == "Newton"
                                ? "[[influences]]\nenergy = \"0.5*x^2\"\non = \"a\"\nfrom_outside = true\n"
                                : "[[influences]]\ninfluence = \"[-sin(time)]\"\non = \"a\"\nfrom_outside = true\n";
  std::string const with_velocity =
      base == "Newton" ? "rate.worked = \"x*velocity.x\"\n" : "rate.worked = \"-x*sin(time)\"\n";
  return "[units]\nbase = \"reduced\"\n[box]\nlow = [-2]\nhigh = [2]\n[run]\nstep = " + std::to_string(step) +
         "\ntime = 1\n[[classes]]\nname = \"Thing\"\nbase = \"" + base +
         "\"\nfields = [{ name = \"charge\" }, { name = \"worked\", default = 0.5 }, { name = \"grown\" }]\n"
         "rate.charge = \"(final_charge - charge)/tau\"\n" +
         with_velocity +
         "rate.grown = \"cos(time)*grown\"\nparameters = { final_charge = 3, tau = 0.7 }\n"
         "[[ensembles]]\nname = \"a\"\nclass = \"Thing\"\nintegrator = \"" +
         method + "\"\nload = { kind = \"positions\", positions = [[1]] }\ngrown = 1\n" + moved;
}

double error_of(std::string const& method, double step, std::string const& base) {
  auto const run = parse_scenario(oscillator(method, step, base), "oscillator.toml");
  run->simulation->run(static_cast<std::uint64_t>(run->steps));
  auto const& a = ensemble(*run, "a");
  double const t = run->simulation->time();
  EXPECT_NEAR(t, 1, 1e-12);
  return std::max({std::abs(number(a, 0, "charge") - 3 * (1 - std::exp(-t / 0.7))),
                   std::abs(number(a, 0, "worked") - (0.5 + 0.5 * (std::cos(t) * std::cos(t) - 1))),
                   std::abs(number(a, 0, "grown") - std::exp(std::sin(t)))});
}

TEST(Classes, FieldsAreAdvancedAtTheOrderOfTheMethod) {
  struct Order {
    char const *method, *base;
    double order;
  };
  for (auto const& [method, base, order] :
       {Order{"euler", "Newton", 1}, Order{"leap-frog", "Newton", 2}, Order{"rk2", "Newton", 2},
        Order{"rk4", "Newton", 4}, Order{"euler", "Tracer", 1}, Order{"rk2", "Tracer", 2}, Order{"rk4", "Tracer", 4}}) {
    double const coarse = error_of(method, 0.05, base), fine = error_of(method, 0.025, base);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.2) << method << " " << base << ": " << coarse << " " << fine;
  }
  EXPECT_LT(error_of("gauss-radau", 0.5, "Newton"), 1e-12);
  EXPECT_LT(error_of("gauss-radau", 0.5, "Tracer"), 1e-12);
}

/// y' = c - y after some steps, by the book.
double relaxed(std::string const& method, double y, double c, double dt, int steps) {
  auto const rate = [c](double at) { return c - at; };
  double known = rate(y);  // leap-frog finds it once a step, for what it predicts
  for (int step = 0; step < steps; ++step) {
    double const k1 = rate(y), k2 = rate(y + 0.5 * dt * k1), k3 = rate(y + 0.5 * dt * k2), k4 = rate(y + dt * k3);
    if (method == "euler") {
      y += dt * k1;
    } else if (method == "rk2") {
      y += dt * k2;
    } else if (method == "rk4") {
      y += dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    } else {
      double const predicted = rate(y + dt * known);
      y += 0.5 * dt * (known + predicted);
      known = predicted;
    }
  }
  return y;
}

// Fields that stand side by side are advanced by twos, some particles at a time; none is left out or taken for another.
TEST(Classes, EachFieldOfEachParticleIsAdvancedByItsOwnRate) {
  constexpr std::size_t fields = 5, particles = 77;
  for (int dimension = 1; dimension <= 3; ++dimension)
    for (std::string const method : {"euler", "leap-frog", "rk2", "rk4"}) {
      auto const vector = [&](std::string const& each) {
        std::string text = "[" + each;
        for (int k = 1; k < dimension; ++k) text += ", " + each;
        return text + "]";
      };
      std::string names, rates;
      for (std::size_t k = 0; k < fields; ++k) {
        std::string const field = "f" + std::to_string(k);
        names += (k ? ", { name = \"" : "{ name = \"") + field + "\" }";
        rates += "rate." + field + " = \"" + std::to_string(k) + " - " + field + "\"\n";
      }
      std::string text =
          "[units]\nbase = \"reduced\"\n[box]\nlow = " + vector("-2") + "\nhigh = " + vector("2") +
          "\n[run]\nstep = 0.25\nsteps = 1\n[[classes]]\nname = \"Thing\"\nbase = \"Newton\"\nfields = [" + names +
          "]\n" + rates + "[[ensembles]]\nname = \"a\"\nclass = \"Thing\"\nintegrator = \"" + method +
          "\"\nload = { kind = \"positions\", positions = [" + vector("0");
      for (std::size_t i = 1; i < particles; ++i) text += ", " + vector("0");
      auto const run = parse_scenario(text + "] }\n", "things.toml");
      auto& a = ensemble(*run, "a");
      auto const at = [&](std::size_t i, std::size_t k) -> double& {
        return a.row(i)[a.field("f" + std::to_string(k)).offset];
      };
      auto const first = [](std::size_t i, std::size_t k) {
        return 0.1 * static_cast<double>(i) - static_cast<double>(k);
      };
      for (std::size_t i = 0; i < particles; ++i)
        for (std::size_t k = 0; k < fields; ++k) at(i, k) = first(i, k);
      run->simulation->run(3);
      for (std::size_t i = 0; i < particles; ++i)
        for (std::size_t k = 0; k < fields; ++k) {
          double const y = relaxed(method, first(i, k), static_cast<double>(k), 0.25, 3);
          ASSERT_NEAR(at(i, k), y, 1e-14) << method << ", particle " << i << ", field " << k;
        }
    }
}

TEST(Classes, RatesThatAnIntegratorTakesStandThereForWhoeverLooks) {
  for (char const* method : {"euler", "rk2", "rk4"}) {
    auto const whole = parse_scenario(oscillator(method, 0.05), "whole.toml");
    whole->simulation->run(20);
    // Between two runs rates are calculated with all the rest.
    auto const pieces = parse_scenario(oscillator(method, 0.05), "pieces.toml");
    for (int n = 0; n < 20; ++n) pieces->simulation->run(1);
    expect_same_rows(ensemble(*whole, "a"), ensemble(*pieces, "a"));
    // Others see the particles in the middle of a run.
    auto const watched = parse_scenario(oscillator(method, 0.05), "watched.toml");
    watched->simulation->observe(3, [](Simulation const&) {});
    watched->simulation->run(20);
    expect_same_rows(ensemble(*whole, "a"), ensemble(*watched, "a"));
    auto const& a = ensemble(*whole, "a");
    double const t = whole->simulation->time();
    whole->schemes[0]->calculate(t);
    EXPECT_NEAR(a.rate(0)[0], (3 - number(a, 0, "charge")) / 0.7, 1e-14) << method;
    EXPECT_NEAR(a.rate(1)[0], number(a, 0, "position") * number(a, 0, "velocity"), 1e-14) << method;
    EXPECT_NEAR(a.rate(2)[0], std::cos(t) * number(a, 0, "grown"), 1e-14) << method;
  }
}

TEST(Classes, DeactivatedParticlesKeepTheirFields) {
  auto const run = parse_scenario(oscillator("deactivate", 0.1), "still.toml");
  run->simulation->run(10);
  EXPECT_EQ(number(ensemble(*run, "a"), 0, "grown"), 1);
}

TEST(Classes, MethodsThatCannotAdvanceFieldsSayWhy) {
  for (char const* method : {"reversible-leap-frog", "symplectic-4"}) {
    auto const lines = test::mistakes_of(oscillator(method, 0.1));
    ASSERT_EQ(lines.size(), 1U) << testing::PrintToString(lines);
    EXPECT_NE(lines[0].find("can't be advanced by " + std::string(method)), std::string::npos) << lines[0];
    EXPECT_NE(lines[0].find("rates of their own"), std::string::npos) << lines[0];
  }
}

/// Two species of spinning discs that push, turn and mark each other within a cut-off; every field is one of D numbers.
std::string mixture(int dimension, std::string const& method, int threads, std::string const& more = "") {
  auto const list = [&](std::string const& one) {
    std::string all = "[";
    for (int a = 0; a < dimension; ++a) all += (a > 0 ? ", " : "") + one;
    return all + "]";
  };
  std::string const count = dimension == 1 ? "3000" : dimension == 2 ? "64" : "16";
  return "[units]\nbase = \"reduced\"\n[box]\nlow = " + list("0") + "\nhigh = " + list(count) +
         "\nboundary = \"periodic\"\n[run]\nstep = 0.01\nsteps = 12\ncutoff = 2.5\nthreads = " +
         std::to_string(threads) +
         "\n[[classes]]\nname = \"Disc\"\nbase = \"Newton\"\nfields = [{ name = \"angle\" }, { name = \"spin\", "
         "default = "
         "0.3 }, { name = \"trail\", kind = \"vector\" }]\nrate.angle = \"spin\"\nrate.spin = 0\n"
         "rate.trail = \"velocity - trail\"\n" +
         more + "[[ensembles]]\nname = \"a\"\nclass = \"Disc\"\nintegrator = \"" + method +
         "\"\nload = { kind = \"fill\", lattice = \"square\", spacing = 1 }\ntemperature = 0.5\nformulas = { angle = "
         "\"sin(3*x)\" }\n[[ensembles]]\nname = \"b\"\nclass = \"Newton\"\nintegrator = \"" +
         method +
         "\"\nload = { kind = \"random\" }\nnumber = 40\ntemperature = 1\n"
         "[[influences]]\nenergy = \"exp(-r^2)*(1 + 0.1*cos(p.angle - q.angle))\"\non = \"a\"\n"
         "[[influences]]\nenergy = \"exp(-r^2)\"\nbetween = [\"a\", \"b\"]\n"
         "[[influences]]\nchanges = \"spin\"\ninfluence = \"0.1*exp(-r^2)*sin(q.angle - p.angle)\"\non = \"a\"\n"
         "[[influences]]\nchanges = \"trail\"\ninfluence = \"separation*exp(-r^2)\"\non = \"a\"\nby = \"b\"\n"
         "[[influences]]\nchanges = \"angle\"\ninfluence = \"0.01*cos(time)\"\non = \"a\"\nfrom_outside = true\n"
         "particles = [0, 5]\n";
}

TEST(Classes, TheSameBitsForAnyNumberOfThreads) {
  for (int dimension = 1; dimension <= 3; ++dimension)
    for (char const* method : {"leap-frog", "rk4"}) {
      auto const one = parse_scenario(mixture(dimension, method, 1, "diffusion.angle = 0.1\n"), "one.toml");
      one->simulation->run(4);
      for (int threads : {2, 3}) {
        auto const many = parse_scenario(mixture(dimension, method, threads, "diffusion.angle = 0.1\n"), "many.toml");
        many->simulation->run(4);
        expect_same_rows(ensemble(*one, "a"), ensemble(*many, "a"));
        expect_same_rows(ensemble(*one, "b"), ensemble(*many, "b"));
      }
    }
}

/// Runs it in one go, and in two with a checkpoint between them.
void expect_same_bits_resumed(std::string const& text) {
  auto const whole = parse_scenario(text, "whole.toml"), half = parse_scenario(text, "half.toml"),
             rest = parse_scenario(text, "rest.toml");
  whole->simulation->run(7);
  half->simulation->run(3);
  for (std::size_t e = 0; e < rest->ensembles.size(); ++e)
    restore_rows(copy_rows(*half->ensembles[e]), *rest->ensembles[e]);
  auto const state = half->simulation->state();
  rest->simulation->restore(3, half->simulation->step_size(), half->simulation->seed(), state);
  rest->simulation->run(4);
  for (std::size_t e = 0; e < rest->ensembles.size(); ++e) expect_same_rows(*whole->ensembles[e], *rest->ensembles[e]);
}

TEST(Classes, AResumedRunHasTheSameBits) {
  for (char const* method : {"leap-frog", "rk2", "rk4", "euler"})
    expect_same_bits_resumed(mixture(2, method, 1, "diffusion.angle = 0.1\n"));
  for (char const* method : {"leap-frog", "gauss-radau"}) expect_same_bits_resumed(oscillator(method, 0.1));
}

/// Three particles on a line, of which only neighbours see each other; each turns towards the mean of those that it sees.
std::string flock(int dimension, std::string const& method) {
  std::string const rest = dimension == 1 ? "" : dimension == 2 ? ", 0.5" : ", 0.5, 0.25";
  auto const at = [&](char const* x) { return "[" + std::string(x) + rest + "]"; };
  return "[units]\nbase = \"reduced\"\n[box]\nlow = " + at("-3") + "\nhigh = " +
         (dimension == 1   ? "[5]"
          : dimension == 2 ? "[5, 5]"
                           : "[5, 5, 5]") +
         "\n[run]\nstep = 0.1\nsteps = 7\ncutoff = 1.5\n[[classes]]\nname = \"Bird\"\nbase = \"Newton\"\n"
         "fields = [{ name = \"angle\" }, { name = \"turn\", sum = true }, { name = \"neighbours\", sum = true }]\n"
         "rate.angle = \"turn/max(neighbours, 1)\"\n[[ensembles]]\nname = \"a\"\nclass = \"Bird\"\nintegrator = \"" +
         method + "\"\nload = { kind = \"positions\", positions = [" + at("0") + ", " + at("1") + ", " + at("2.2") +
         "] }\nformulas = { angle = \"x^2\" }\n[[influences]]\nchanges = \"turn\"\ninfluence = \"sin(q.angle - "
         "p.angle)\"\n"
         "on = \"a\"\n[[influences]]\nchanges = \"neighbours\"\ninfluence = \"1\"\non = \"a\"\n";
}

TEST(Classes, SumsOverNeighboursAreThoseByHand) {
  for (int dimension = 1; dimension <= 3; ++dimension) {
    auto const run = parse_scenario(flock(dimension, "euler"), "flock.toml");
    auto const& a = ensemble(*run, "a");
    double angle[] = {0, 1, 4.84};
    for (int step = 0; step < 3; ++step) {
      run->simulation->run(1);
      double const left = std::sin(angle[1] - angle[0]), right = std::sin(angle[2] - angle[1]);
      angle[0] += 0.1 * left, angle[1] += 0.1 * (right - left) / 2, angle[2] -= 0.1 * right;
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(number(a, i, "angle"), angle[i], 1e-14) << dimension << "D";
    }
  }
  for (char const* method : {"leap-frog", "rk2", "rk4", "euler"}) expect_same_bits_resumed(flock(2, method));
}

TEST(Classes, PairsChangeFieldsAsAPlainSumHasIt) {
  for (int dimension = 1; dimension <= 3; ++dimension) {
    auto const run = parse_scenario(mixture(dimension, "euler", 1), "sum.toml");
    auto& a = ensemble(*run, "a");
    auto& b = ensemble(*run, "b");
    run->simulation->run(1);
    for (auto* scheme : run->simulation->schemes()) scheme->calculate(0.25);
    Box const& box = run->box();
    auto const between = [&](AnyEnsemble const& p, std::size_t i, AnyEnsemble const& q, std::size_t j) {
      std::array<double, 4> d{};  // and the square
      for (int c = 0; c < dimension; ++c) {
        auto const k = static_cast<std::size_t>(c);
        d[k] = q.row(j)[c] - p.row(i)[c];
        d[k] -= std::round(d[k] / box.length(c)) * box.length(c);
        d[3] += d[k] * d[k];
      }
      return d;
    };
    for (std::size_t i = 0; i < 25; ++i) {
      double spin = 0;
      std::array<double, 3> trail{};
      for (std::size_t j = 0; j < a.size(); ++j) {
        double const s = between(a, i, a, j)[3];
        if (j != i && s < 6.25) spin += 0.1 * std::exp(-s) * std::sin(number(a, j, "angle") - number(a, i, "angle"));
      }
      for (std::size_t j = 0; j < b.size(); ++j) {
        auto const d = between(a, i, b, j);
        for (int c = 0; c < dimension && d[3] < 6.25; ++c)
          trail[static_cast<std::size_t>(c)] += d[static_cast<std::size_t>(c)] * std::exp(-d[3]);
      }
      std::size_t const at = i * a.rate_stride();
      double const outside = i == 0 || i == 5 ? 0.01 * std::cos(0.25) : 0;
      EXPECT_NEAR(a.rate(0)[at], number(a, i, "spin") + outside, 1e-12);
      EXPECT_NEAR(a.rate(1)[at], spin, 1e-12);
      for (int c = 0; c < dimension; ++c)
        EXPECT_NEAR(a.rate(2)[at + static_cast<std::size_t>(c)],
                    number(a, i, "velocity", c) - number(a, i, "trail", c) + trail[static_cast<std::size_t>(c)], 1e-12);
    }
  }
}

TEST(Classes, DiffusionIsThatOfItsCoefficient) {
  std::string const text =
      "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0]\nhigh = [1, 1]\n[run]\nstep = 0.1\nsteps = "
      "20\n[[classes]]\nname = "
      "\"Walker\"\nbase = \"Tracer\"\nfields = [{ name = \"angle\" }, { name = \"place\", kind = \"vector\" }, { name "
      "= "
      "\"width\" }]\nrate.angle = 1\ndiffusion.angle = 0.25\nrate.place = \"[0, 0]\"\ndiffusion.place = \"width^2\"\n"
      "[[ensembles]]\nname = \"a\"\nclass = \"Walker\"\nload = { kind = \"random\" }\nnumber = 40000\nwidth = 2\n";
  auto const run = parse_scenario(text, "walk.toml");
  run->simulation->run(20);
  auto const& a = ensemble(*run, "a");
  double const n = 40000;
  double mean = 0, angle2 = 0, x2 = 0, y2 = 0, xy = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    double const away = number(a, i, "angle") - 2, x = number(a, i, "place"), y = number(a, i, "place", 1);
    mean += away / n, angle2 += away * away / n, x2 += x * x / n, y2 += y * y / n, xy += x * y / n;
  }
  // Variances of normal numbers have the standard error sqrt(2/n) of themselves.
  EXPECT_NEAR(mean, 0, 5 * std::sqrt(1 / n));
  EXPECT_NEAR(angle2, 2 * 0.25 * 2, 5 * std::sqrt(2 / n));
  EXPECT_NEAR(x2, 2 * 4 * 2, 5 * std::sqrt(2 / n) * 16);
  EXPECT_NEAR(y2, 2 * 4 * 2, 5 * std::sqrt(2 / n) * 16);
  EXPECT_NEAR(xy, 0, 5 * 16 / std::sqrt(n));
}

// ---- Classes without rates, and laws of the base ----

std::string argon(std::string const& derived, std::string const& name) {
  return "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0, 0]\nhigh = [8, 8, 8]\nboundary = \"periodic\"\n[run]\nstep "
         "= "
         "0.004\nsteps = 20\ncutoff = 2.5\n" +
         derived + "[[ensembles]]\nname = \"a\"\nclass = \"" + name +
         "\"\nload = { kind = \"block\", lattice = \"fcc\", spacing = 1.13, counts = [5, 5, 5] }\ntemperature = "
         "1\n[[influences]]\nlaw = "
         "\"lennard-jones\"\ndepth = 1\nr0 = 1.1\non = \"a\"\n";
}

TEST(Classes, FieldsThatNothingReadsChangeNoBit) {
  auto const plain = parse_scenario(argon("", "Newton"), "plain.toml");
  auto const derived = parse_scenario(argon("[[classes]]\nname = \"Atom\"\nbase = \"Newton\"\nfields = [{ name = "
                                            "\"colour_number\", default = 7 }, { name = "
                                            "\"memory\", kind = \"vector\" }]\n",
                                            "Atom"),
                                      "derived.toml");
  plain->simulation->run(20);
  derived->simulation->run(20);
  auto const &p = ensemble(*plain, "a"), &d = ensemble(*derived, "a");
  EXPECT_GT(d.stride(), p.stride());
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_EQ(std::memcmp(p.row(i), d.row(i), p.doubles() * sizeof(double)), 0);
    EXPECT_EQ(number(d, i, "colour_number"), 7);
  }
}

TEST(Classes, LawsOfAShippedClassActOnOneWithItsFields) {
  std::string const text =
      "[box]\nlow = [0, 0]\nhigh = [1, 1]\n[run]\nstep = \"1 s\"\nsteps = 1\n[[classes]]\nname = \"Grain\"\nbase = "
      "\"Newton\"\nfields = [{ name = \"charge\", unit = \"e\", default = \"2 e\" }]\n[[ensembles]]\nname = "
      "\"a\"\nclass = "
      "\"Grain\"\nmass = 1\nload = { kind = \"positions\", positions = [[0.25, 0.5], [0.75, 0.5]] "
      "}\n[[influences]]\nlaw = \"coulomb\"\nk = 3\non = \"a\"\n";
  auto const run = parse_scenario(text, "coulomb.toml");
  run->simulation->run(0);
  double const e = 1.602176634e-19;
  EXPECT_NEAR(ensemble(*run, "a").influence(1)[0] / (2 * 3 * 4 * e * e / 0.5), 1, 1e-9);  // in a plane 2 k q q' / r
  auto const lines = test::mistakes_of(replaced(text, "charge\", unit = \"e\", default = \"2 e\"", "tint\""));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("law 'coulomb' needs a charge; class Grain has none"), std::string::npos) << lines[0];
}

TEST(Classes, ChargesOfAMeshMayGrow) {
  // Two plates of charge that grow: the field between them follows. One dimension, a periodic mesh.
  std::string const text =
      "[units]\nbase = \"reduced\"\n[box]\nlow = [0]\nhigh = [8]\nboundary = \"periodic\"\n[run]\nstep = 0.05\nsteps = "
      "20\n[mesh]\nlaw = \"coulomb\"\ncells = 64\nk = 1\n[[classes]]\nname = \"Growing\"\nbase = \"Coulomb\"\nfields = "
      "[{ name = \"sign\" "
      "}]\nrate.charge = \"sign - charge\"\n[[ensembles]]\nname = \"a\"\nclass = \"Growing\"\nmass = 1e9\nload = { "
      "kind = "
      "\"positions\", positions = [[2], [6]] }\nsign = [1, -1]\n";
  auto const run = parse_scenario(text, "plates.toml");
  run->simulation->run(20);
  auto& a = ensemble(*run, "a");
  double const charge = 1 - std::exp(-1.0);
  EXPECT_NEAR(number(a, 0, "charge"), charge, 1e-3);
  EXPECT_NEAR(number(a, 1, "charge"), -charge, 1e-3);
  for (auto* scheme : run->simulation->schemes()) scheme->calculate(1);
  double const now = number(a, 0, "charge");
  auto const before = a.influence(0)[0];
  a.row(0)[a.field("charge").offset] = 2 * now, a.row(1)[a.field("charge").offset] = -2 * now;
  for (auto* scheme : run->simulation->schemes()) scheme->calculate(1);
  EXPECT_NEAR(a.influence(0)[0], 4 * before, 1e-9 + 1e-6 * std::abs(before));
}

TEST(Classes, PiecesOfAContinuumMayHaveFieldsOfTheirOwn) {
  auto const text = [](std::string const& derived, std::string const& name) {
    return "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0]\nhigh = [12, 12]\nboundary = \"periodic\"\n[run]\nstep = "
           "0.01\nsteps = 10\n[smooth]\nweight = \"lucy\"\n" +
           derived + "[[ensembles]]\nname = \"a\"\nclass = \"" + name +
           "\"\nload = { kind = \"fill\", lattice = \"square\", spacing = 1 }\nmass = 1\nrange = 3\nmaterial = { kind "
           "= "
           "\"ideal-gas\", gamma = 1.4 }\nformulas = { specific_energy = \"1 + 0.1*sin(2*pi*x/12)\" }\n";
  };
  auto const plain = parse_scenario(text("", "Smooth"), "plain.toml");
  auto const derived =
      parse_scenario(text("[[classes]]\nname = \"Dyed\"\nbase = \"Smooth\"\nfields = [{ name = \"age\" }, { "
                          "name = \"way\" }]\nrate.age = 1\nrate.way = \"norm(velocity)\"\n",
                          "Dyed"),
                     "derived.toml");
  plain->simulation->run(10);
  derived->simulation->run(10);
  auto const &p = ensemble(*plain, "a"), &d = ensemble(*derived, "a");
  double way = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_EQ(std::memcmp(p.row(i), d.row(i), p.doubles() * sizeof(double)), 0) << i;
    EXPECT_NEAR(number(d, i, "age"), 0.1, 1e-12);
    way = std::max(way, number(d, i, "way"));
  }
  EXPECT_GT(way, 1e-5);
}

// ---- What is wrong ----

// The numbers on the right are those of the lines.
std::string const good =
    "[box]\n"                                                                                                // 1
    "low = [0, 0]\n"                                                                                         // 2
    "high = [1, 1]\n"                                                                                        // 3
    "[run]\n"                                                                                                // 4
    "step = \"1 s\"\n"                                                                                       // 5
    "steps = 2\n"                                                                                            // 6
    "[[classes]]\n"                                                                                          // 7
    "name = \"Grain\"\n"                                                                                     // 8
    "base = \"Newton\"\n"                                                                                    // 9
    "fields = [{ name = \"charge\", unit = \"e\" }, { name = \"way\", kind = \"vector\", unit = \"m\" }]\n"  // 10
    "rate.charge = \"(full - charge)/tau\"\n"                                                                // 11
    "rate.way = \"velocity\"\n"                                                                              // 12
    "parameters = { full = \"100 e\", tau = \"1 s\" }\n"                                                     // 13
    "[[ensembles]]\n"                                                                                        // 14
    "name = \"a\"\n"                                                                                         // 15
    "class = \"Grain\"\n"                                                                                    // 16
    "mass = 1\n"                                                                                             // 17
    "load = { kind = \"random\" }\n"                                                                         // 18
    "number = 3\n"                                                                                           // 19
    "charge = \"1 e\"\n"                                                                                     // 20
    "[[influences]]\n"                                                                                       // 21
    "changes = \"charge\"\n"                                                                                 // 22
    "influence = \"leak*(q.charge - p.charge)\"\n"                                                           // 23
    "parameters = { leak = \"2 1/s\" }\n"                                                                    // 24
    "on = \"a\"\n";                                                                                          // 25

std::string with(std::string const& old, std::string const& now) { return replaced(good, old, now); }

class ClassMistakes : public testing::TestWithParam<Mistake> {};
TEST_P(ClassMistakes, AreOneLineWithTheirPlace) { expect_one_line(GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Every, ClassMistakes,
    testing::Values(
        Mistake{"not a rate", with("(full - charge)/tau", "full - charge"), "11:16", {"a charge in a time", "this is"}},
        Mistake{"a sum of two dimensions",
                with("(full - charge)/tau", "(full - tau)/tau"),
                "11:22",
                {"a charge and a time"}},
        Mistake{"an unknown name", with("(full - charge)/tau", "(full - chorge)/tau"), "11:24", {"chorge", "'charge'"}},
        Mistake{"a number for a vector",
                with("rate.way = \"velocity\"", "rate.way = \"velocity.x\""),
                "12:13",
                {"way is a vector"}},
        Mistake{"a vector for a number", with("(full - charge)/tau", "velocity"), "11:16", {"charge is a number"}},
        Mistake{"a rate for nothing", with("rate.way", "rate.wey"), "12:6", {"rate.wey", "did you mean 'way'"}},
        Mistake{"a rate of the velocity",
                with("rate.way = \"velocity\"", "rate.velocity = \"velocity\""),
                "12:17",
                {"laws move particles"}},
        Mistake{"an unknown base", with("\"Newton\"", "\"Newtom\""), "9:8", {"did you mean 'Newton'"}},
        Mistake{"an unknown unit", with("unit = \"e\"", "unit = \"elephant\""), "10:37", {"unit: ", "elephant"}},
        Mistake{"a field of the base", with("name = \"way\"", "name = \"mass\""), "10:53", {"'mass'"}},
        Mistake{"a key of ensembles", with("name = \"way\"", "name = \"drift\""), "10:53", {"key of [[ensembles]]"}},
        Mistake{
            "a name of files", with("name = \"way\"", "name = \"count\""), "10:53", {"trajectories need this name"}},
        Mistake{
            "a name of formulas", with("name = \"way\"", "name = \"time\""), "10:53", {"something else in formulas"}},
        Mistake{"an unknown key", with("kind = \"vector\"", "kynd = \"vector\""), "10:60", {"kynd", "kind"}},
        Mistake{"a diffusion alone", with("rate.way = \"velocity\"", "diffusion.way = 0"), "12:17", {"needs a rate"}},
        Mistake{"a diffusion of what changes",
                with("rate.way = \"velocity\"", "rate.way = \"velocity\"\ndiffusion.charge = \"charge*full/tau\""),
                "13:21",
                {"'charge' changes during a step"}},
        Mistake{"a value of another dimension", with("charge = \"1 e\"", "charge = \"1 m\""), "20:10", {"charge"}},
        Mistake{"an unknown field", with("charge = \"1 e\"", "chrge = \"1 e\""), "20:1", {"chrge", "charge"}},
        Mistake{"changes what is not there",
                with("changes = \"charge\"", "changes = \"charg\""),
                "22:11",
                {"charg", "'charge'"}},
        Mistake{"changes what does not change",
                with("changes = \"charge\"", "changes = \"mass\""),
                "22:11",
                {"mass of class Grain has no rate", "rate.mass = 0"}},
        Mistake{"an influence that is no rate", with("leak*(q", "(q"), "23:14", {"a charge in a time"}},
        Mistake{"an energy",
                with("influence = \"leak*(q.charge - p.charge)\"", "energy = \"leak*(q.charge - p.charge)\""),
                "22:11",
                {"changes", "an energy moves particles"}},
        Mistake{"not finite",
                replaced(with("(full - charge)/tau", "(full - charge)/tau + full^2/charge/tau"), "charge = \"1 e\"",
                         "charge = 0"),
                "18:8",
                {"the rate of charge of particle 0 of 'a' is not finite"}}),
    mistake_name);

TEST(Classes, NamesOfShippedClassesAreTaken) {
  auto const lines = test::mistakes_of(with("name = \"Grain\"", "name = \"Coulomb\""));
  ASSERT_EQ(lines.size(), 2U) << "and there is no Grain";
  EXPECT_EQ(lines[0], "test.toml:8:8: name: there is a class Coulomb already");
}

TEST(Classes, WhatIsMissingIsAMistakeAndNothingElse) { test::expect_mistakes_of_what_is_missing(good, 20, 1); }

}  // namespace
}  // namespace boltzmann::classes_test
