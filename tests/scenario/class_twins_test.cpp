// Shipped classes beside the same classes made of formulas in a scenario: their particles are the same after some steps.
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include "mistakes.hpp"

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace boltzmann::class_twins_test {
namespace {

/// A class, and what moves it: as it is shipped, and typed. `called`: what its fields are called there, where the shipped
/// names mean something to the program.
struct Twin {
  char const* shipped;
  int dimension;
  char const *laws, *base, *typed_class, *typed_laws;
  std::map<std::string, std::string> called = {};
  char const* method = "leap-frog";
};

std::ostream& operator<<(std::ostream& out, Twin const& twin) { return out << twin.shipped << twin.dimension; }

// Of (q - p) x omega_q (r^2 + core^2)^(-3/2) / (4 pi), times omega_p, the gradient by the place of p.
constexpr char const* stretched = R"toml(
[[influences]]
on = "a"
influence = "cross(separation, q.turning)*w^3/(4*pi)"
where = { w = "(r^2 + q.radius^2)^-0.5" }
[[influences]]
on = "a"
changes = "turning"
influence = "(cross(p.turning, q.turning)*w^3 + 3*dot(p.turning, cross(separation, q.turning))*separation*w^5)/(4*pi)"
where = { w = "(r^2 + q.radius^2)^-0.5" }
)toml";
constexpr char const* carried_by_plain_cores = R"toml(
[[influences]]
on = "a"
influence = "q.turning/(2*pi)*[separation.y, -separation.x]/max(r, q.radius)^2"
)toml";
std::map<std::string, std::string> const of_vortices{{"vorticity", "turning"}, {"core", "radius"}, {"viscosity", "nu"}};

Twin const twins[] = {
    {"Coulomb", 3, R"toml(
[[influences]]
law = "coulomb"
k = 1.5
softening = 0.2
on = "a"
[[influences]]
law = "uniform-electric-field"
field = [1, -2, 0.5]
on = "a"
)toml",
     "Newton", "fields = [{ name = \"charge\" }]\n", R"toml(
[[influences]]
energy = "1.5*p.charge*q.charge/sqrt(r^2 + 0.04)"
on = "a"
[[influences]]
energy = "-charge*dot([1, -2, 0.5], position)"
from_outside = true
on = "a"
)toml"},
    {"Kepler", 3, R"toml(
[[influences]]
law = "gravity"
G = 2
softening = 0.2
on = "a"
)toml",
     "Newton", "", R"toml(
[[influences]]
energy = "-2*p.mass*q.mass/sqrt(r^2 + 0.04)"
on = "a"
)toml"},
    {"Tethered",
     2,
     R"toml(
[[influences]]
law = "tether"
on = "a"
)toml",
     "Newton",
     "fields = [{ name = \"home\", kind = \"vector\" }, { name = \"stiffness\" }]\n",
     R"toml(
[[influences]]
energy = "0.5*stiffness*norm(position - home)^2"
from_outside = true
on = "a"
)toml",
     {{"anchor", "home"}}},
    {"Pendulum",
     1,
     R"toml(
[[influences]]
law = "pendulum-gravity"
acceleration = 3
on = "a"
)toml",
     "Newton",
     "fields = [{ name = \"length\" }, { name = \"bob_mass\" }, { name = \"pivot_x\" }]\n",
     R"toml(
[[influences]]
influence = "-bob_mass*3*length*sin(x)"
from_outside = true
on = "a"
)toml",
     {{"pivot", ""}}},
    {"Vortex", 2, R"toml(
[[influences]]
law = "biot-savart"
on = "a"
)toml",
     "Tracer", "fields = [{ name = \"turning\" }, { name = \"radius\" }]\n", carried_by_plain_cores, of_vortices,
     "rk4"},
    {"Inviscid", 2, R"toml(
[[influences]]
law = "biot-savart"
on = "a"
)toml",
     "Tracer", "fields = [{ name = \"turning\" }, { name = \"radius\" }]\n", carried_by_plain_cores, of_vortices,
     "rk2"},
    {"Vortex", 3, R"toml(
[[influences]]
law = "biot-savart"
on = "a"
)toml",
     "Tracer", "fields = [{ name = \"turning\", kind = \"vector\" }, { name = \"radius\" }]\n", R"toml(
[[influences]]
influence = "cross(separation, q.turning)/(4*pi*(r^2 + q.radius^2)^1.5)"
on = "a"
)toml",
     of_vortices, "rk4"},
    {"Inviscid", 3, R"toml(
[[influences]]
law = "biot-savart"
on = "a"
)toml",
     "Tracer",
     "fields = [{ name = \"turning\", kind = \"vector\" }, { name = \"radius\" }]\nrate.turning = \"[0, 0, 0]\"\n",
     stretched, of_vortices, "rk4"},
    {"Spreading", 2, R"toml(
[[influences]]
law = "biot-savart-gaussian"
on = "a"
)toml",
     "Tracer",
     "fields = [{ name = \"turning\" }, { name = \"radius\" }, { name = \"nu\" }]\nrate.radius = \"nu/radius\"\n",
     R"toml(
[[influences]]
influence = "q.turning/(2*pi)*[separation.y, -separation.x]*(1 - exp(-r^2/(2*q.radius^2)))/r^2"
on = "a"
)toml",
     of_vortices, "rk4"},
    {"Spreading", 3, R"toml(
[[influences]]
law = "biot-savart"
on = "a"
)toml",
     "Tracer",
     "fields = [{ name = \"turning\", kind = \"vector\" }, { name = \"radius\" }, { name = \"nu\" }]\n"
     "rate.radius = \"nu/radius\"\nrate.turning = \"[0, 0, 0]\"\n",
     stretched, of_vortices, "rk4"},
    {"Diffusive", 2, R"toml(
[[influences]]
law = "biot-savart"
on = "a"
[[influences]]
law = "vorticity-exchange"
on = "a"
)toml",
     "Tracer",
     "fields = [{ name = \"turning\" }, { name = \"radius\" }, { name = \"nu\" }, { name = \"volume\" }]\n"
     "rate.turning = 0\n",
     R"toml(
[[influences]]
on = "a"
influence = "q.turning/(2*pi)*[separation.y, -separation.x]/max(r, q.radius)^2"
[[influences]]
on = "a"
changes = "turning"
influence = "(p.nu + q.nu)/s*(p.volume*q.turning - q.volume*p.turning)*exp(-r^2/(2*s))/(2*pi*s)"
where = { s = "(p.radius^2 + q.radius^2)/2" }
)toml",
     of_vortices, "rk4"},
};

/// Those that are no formulas.
struct Untyped {
  char const *name, *why;
};
constexpr Untyped untyped[] = {
    {"Newton", "it is what others are derived from"},
    {"Tracer", "it is what others are derived from"},
    {"Meso", "friction and noise of [[dissipation]] change its internal energy"},
    {"Dye", "[[dye]] releases it, and it remembers when"},
    {"Viscous", "its place takes a random walk; 'diffusion' is of fields"},
    {"Smooth", "several passes find its densities, stresses and rates"},
    {"Solid", "several passes find its densities, stresses and rates"},
};

TEST(ClassTwins, AreOfAllClassesThatCanBeTyped) {
  for (auto const& one : particle_classes()) {
    bool const typed =
        std::any_of(std::begin(twins), std::end(twins), [&](Twin const& twin) { return one.name == twin.shipped; });
    bool const told =
        std::any_of(std::begin(untyped), std::end(untyped), [&](Untyped const& no) { return one.name == no.name; });
    EXPECT_NE(typed, told) << one.name;
  }
}

std::string scenario_of(Twin const& twin, bool typed) {
  auto const list = [&](std::string const& one) {
    std::string all = one;
    for (int a = 1; a < twin.dimension; ++a) all += ", " + one;
    return "[" + all + "]";
  };
  return "[units]\nbase = \"reduced\"\n[box]\nlow = " + list("-50") + "\nhigh = " + list("50") +
         "\nboundary = \"open\"\n[run]\nstep = 0.01\nsteps = 20\n" +
         (typed ? std::string("[[classes]]\nname = \"Typed\"\nbase = \"") + twin.base + "\"\n" + twin.typed_class
                : "") +
         "[[ensembles]]\nname = \"a\"\nclass = \"" + (typed ? "Typed" : twin.shipped) + "\"\nintegrator = \"" +
         twin.method + "\"\nnumber = 7\nload = { kind = \"random\" }\n" +
         (twin.called == of_vortices ? typed ? "radius = 1\n" : "core = 1\n" : "") +
         (typed ? twin.typed_laws : twin.laws);
}

class ClassTwins : public testing::TestWithParam<Twin> {};

TEST_P(ClassTwins, MoveAlike) {
  Twin const& twin = GetParam();
  auto const shipped = parse_scenario(scenario_of(twin, false), "shipped.toml"),
             typed = parse_scenario(scenario_of(twin, true), "typed.toml");
  auto &a = test::ensemble(*shipped, "a"), &b = test::ensemble(*typed, "a");
  auto const twin_of = [&](Field const& field) -> Field const* {
    auto const name = twin.called.find(field.name);
    std::string const called = name == twin.called.end() ? field.name : name->second;
    return called.empty() ? nullptr : &b.field(called);
  };
  std::mt19937_64 random(test_seed(5));
  std::uniform_real_distribution<double> some(0.5, 1.5);
  for (auto const& field : a.fields()) {
    Field const* const other = twin_of(field);
    for (std::size_t i = 0; i < a.size(); ++i)
      for (int c = 0; c < field.components; ++c) {
        double const x = field.name == "position" ? 4 * some(random) : some(random);
        a.row(i)[field.offset + c] = x;
        if (other) b.row(i)[other->offset + c] = x;
      }
  }
  std::vector<double> const start(a.row(0), a.row(0) + a.size() * a.stride());
  shipped->simulation->run(20);
  typed->simulation->run(20);
  double furthest = 0;
  for (auto const& field : a.fields()) {
    Field const* const other = twin_of(field);
    if (!other) continue;
    double change = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      for (int c = 0; c < field.components; ++c) {
        double const x = a.row(i)[field.offset + c];
        change = std::max(change, std::abs(x - start[i * a.stride() + static_cast<std::size_t>(field.offset + c)]));
        EXPECT_NEAR(x, b.row(i)[other->offset + c], 1e-12 * std::max(1.0, std::abs(x))) << field.name << " of " << i;
      }
    bool const still = change == 0;
    EXPECT_EQ(still, b.number_driven(*other) < 0 && field.name != "position" && field.name != "velocity") << field.name;
    if (field.name == "position") furthest = change;
  }
  EXPECT_GT(furthest, 1e-3);  // what is the same has come somewhere
}

INSTANTIATE_TEST_SUITE_P(All, ClassTwins, testing::ValuesIn(twins), [](auto const& info) {
  return info.param.shipped + std::to_string(info.param.dimension) + "D";
});

}  // namespace
}  // namespace boltzmann::class_twins_test
