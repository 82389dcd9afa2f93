// Kind: what 'bzm check' accepts and 'bzm run' refuses before its first step. Siblings: names that files cannot have, of
// ensembles and fields; pictures with tracks of particles that come and go, by each cause.
#include "tests/cases/case.hpp"

namespace boltzmann::names_test {
namespace {

using namespace boltzmann::test;

constexpr char const* head =
    "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0]\nhigh = [8, 8]\nboundary = \"open\"\n"
    "[run]\nstep = 0.01\nsteps = 4\ncutoff = 2.5\n";

/// An ensemble of 4 particles.
std::string ensemble(std::string const& name, std::string const& more = "class = \"Newton\"\n") {
  return "[[ensembles]]\nname = \"" + name + "\"\n" + more +
         "mass = 1\nload = { kind = \"positions\", positions = [[1, 1], [3, 1], [1, 3], [3, 3]] }\n";
}

/// 'check' and 'run' give the same line, with the number of the line in the file.
void expect_refused(std::string const& text, std::string const& wrong, std::string const& part) {
  Case const one("wrong", text);
  auto const at = text.find(wrong);
  ASSERT_NE(at, std::string::npos);
  auto const line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  auto const checked = one.check(), run = one.run();
  EXPECT_EQ(checked.status, 2) << text;
  EXPECT_EQ(run.status, 2) << text;
  EXPECT_EQ(checked.err, run.err);
  EXPECT_EQ(lines_in(checked.err), 1U) << checked.err;
  EXPECT_EQ(checked.err.rfind("wrong.toml:" + std::to_string(line) + ":", 0), 0U) << checked.err;
  EXPECT_TRUE(has(checked.err, part)) << checked.err;
  EXPECT_FALSE(fs::exists(one / "run"));
}

TEST(Names, ThatFilesCannotHaveAreRefusedByCheckWithTheirLine) {
  for (std::string const name : {"a/b", "/", ".", ".."})
    expect_refused(head + ensemble(name), "name = ", "an ensemble can't be called '" + name + "' in files");
  for (std::string const name : {"a\\tb", "a\\nb", "a\\u0007", "a\\u007f"})
    expect_refused(head + ensemble(name), "name = ", "control character");
  expect_refused(head + ensemble(std::string(101, 'n')), "name = ", "an ensemble can't be called '");
  for (std::string const field : {"id", "species", "count", "box"})
    expect_refused(head + std::string("[[classes]]\nname = \"Mine\"\nbase = \"Newton\"\nfields = [{ name = \"") +
                       field + "\" }]\n" + ensemble("atoms", "class = \"Mine\"\n"),
                   "fields = ", "trajectories need this name for themselves");
}

TEST(Names, OfAllOtherKindsGoThroughARunAndAResume) {
  for (std::string const name : {"a b", "a.b", "a,b", "a'b", "ä€𝛼", "-a", "a:b", "a\\\\b", "a\\\"b", "a[0]", "{}", "%s",
                                 "position", "box", "id"}) {
    Case const one("right", head + ensemble(name) + "[[influences]]\nlaw = \"lennard-jones\"\non = \"" + name +
                                "\"\ndepth = 1\nr0 = 1\n[[diagnoses]]\nkind = \"energies\"\n[[diagnoses]]\nkind = "
                                "\"temperature\"\nensembles = [\"" +
                                name + "\"]\n[output]\ndiagnoses = 1\ntrajectory = 1\n");
    auto const checked = one.check();
    EXPECT_EQ(checked.status, 0) << name << ": " << checked.err;
    auto const run = one.run({"--quiet"});
    EXPECT_EQ(run.status, 0) << name << ": " << run.err;
    auto const resumed = bzm({"resume", "run", "--steps", "2", "--quiet"}, one.string());
    EXPECT_EQ(resumed.status, 0) << name << ": " << resumed.err;
    auto const exported = bzm({"export", "run", "-o", "a.xyz"}, one.string());
    EXPECT_EQ(exported.status, 0) << name << ": " << exported.err;
  }
}

TEST(Names, TracksOfParticlesThatComeAndGoAreRefusedByCheckWithTheirLine) {
  std::string const picture =
      "[output]\ntrajectory = 1\n[[output.pictures]]\ndrawing = \"cartesian\"\nfile = \"a.png\"\ntrace = true\n";
  std::string const vortices =
      "[[ensembles]]\nname = \"atoms\"\nclass = \"Vortex\"\nvorticity = 0.1\ncore = 0.5\nload = { kind = "
      "\"positions\", "
      "positions = [[1, 1], [3, 1]] }\n[[influences]]\nlaw = \"biot-savart\"\non = \"atoms\"\n";
  for (std::string const& before :
       {ensemble("atoms") +
            "[[events]]\nat = 0.02\non = \"atoms\"\nadd = { load = { kind = \"positions\", positions = [[5, "
            "5]] } }\n",
        vortices + "[[outflow]]\non = \"atoms\"\nfrom = [7, 0]\ndirection = [1, 0]\n",
        vortices + "[[remesh]]\nevery = 2\non = \"atoms\"\nspacing = 0.5\n"}) {
    std::string text = head + before + picture;
    expect_refused(text, "trace = ", "a picture with tracks needs particles that keep their numbers");
    text.replace(text.find("trace = true"), 12, "trace = false");
    EXPECT_EQ(Case("right", text).check().status, 0) << Case("right", text).check().err;
  }
}

}  // namespace
}  // namespace boltzmann::names_test
