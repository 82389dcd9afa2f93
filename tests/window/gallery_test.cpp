// The gallery: what the start page is told of scenarios, and what it may write.
#include <boltzmann/window/gallery.hpp>

#include "../files/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tests/cpu_time.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace boltzmann::gallery_test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

std::string read(fs::path const& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

json find(json const& list, std::string const& key, std::string const& value) {
  for (auto const& one : list)
    if (one.at(key) == value) return one;
  return nullptr;
}

/// A scenario of one atom in 1D.
std::string small(std::string const& title) {
  return "title = \"" + title +
         "\"\n[units]\nbase = \"reduced\"\n[box]\nlow = [0]\nhigh = [9]\n[run]\nstep = 0.1   # of a second\nsteps = 3\n"
         "[[ensembles]]\nname = \"atoms\"\nclass = \"Newton\"\nmass = 1\n"
         "load = { kind = \"positions\", positions = [[1]] }\n";
}

class GalleryTest : public testing::Test {
 protected:
  TemporaryFolder folder;
  Gallery gallery{folder.path};

  void put(std::string const& name, std::string const& text) const { std::ofstream(folder / name) << text; }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()));
  }
};

TEST_F(GalleryTest, ListsEveryShippedScenarioAtOnce) {
  double const since = cpu_seconds();
  json const reply = gallery.scenarios();
  double const seconds = cpu_seconds() - since;
  RecordProperty("milliseconds", static_cast<int>(1000 * seconds));
  std::printf("[ LIST     ] %.1f ms\n", 1000 * seconds);
  EXPECT_LT(seconds, 1.0);
  EXPECT_EQ(reply.at("ok"), true);
  auto const& list = reply.at("scenarios");
  ASSERT_EQ(list.size(), shipped_scenarios().size());
  std::size_t k = 0;
  for (auto const& name : shipped_scenarios()) {
    auto const& one = list[k++];
    EXPECT_EQ(one.at("name"), name);
    EXPECT_FALSE(one.at("title").get<std::string>().empty());
    EXPECT_FALSE(one.at("description").get<std::string>().empty());
    EXPECT_EQ(one.at("own"), false);
    ASSERT_TRUE(one.at("picture").is_string()) << name << " has no picture in docs/gallery";
    auto const picture = gallery.picture(one.at("picture").get<std::string>());
    ASSERT_TRUE(picture) << name;
    EXPECT_EQ(picture->type, "image/png");
    // PNG's head: 480 x 360.
    EXPECT_EQ(picture->content->substr(0, 8), "\x89PNG\r\n\x1a\n");
    EXPECT_EQ(picture->content->substr(16, 8), std::string("\0\0\x01\xe0\0\0\x01\x68", 8)) << name;
  }
  json const copper = find(list, "name", "copper");
  EXPECT_EQ(copper.at("dimension"), 2);
  EXPECT_EQ(copper.at("steps"), 2000);
  EXPECT_EQ(copper.at("particles"), 250);
  EXPECT_TRUE(find(list, "name", "cavitation").at("steps").is_null());  // by the Courant step
}

TEST_F(GalleryTest, OwnScenariosComeAfterTheShipped) {
  put("zebra.toml", small("Stripes"));
  put("ant.toml", small("Six legs"));
  put("copper.toml", small("Another copper"));
  put("pyproject.toml", "[project]\nname = \"x\"\n");
  put("broken.toml", "title = \n");
  put("note.txt", small("no"));
  put("latin\xe9.toml", small("not to be told in JSON"));
  fs::create_directory(folder / "folder.toml");
  json const list = gallery.scenarios().at("scenarios");
  std::vector<std::string> own;
  for (std::size_t k = shipped_scenarios().size(); k < list.size(); ++k) {
    own.push_back(list[k].at("name"));
    EXPECT_EQ(list[k].at("own"), true);
    EXPECT_TRUE(list[k].at("picture").is_null());
    EXPECT_EQ(list[k].at("particles"), 1);
  }
  EXPECT_EQ(own, (std::vector<std::string>{"ant", "copper.toml", "zebra"}));
  EXPECT_EQ(gallery.scenario("copper.toml").at("title"), "Another copper");
  EXPECT_NE(gallery.scenario("copper").at("title"), "Another copper");
  EXPECT_EQ(gallery.load("copper.toml", {})->title, "Another copper");
}

TEST_F(GalleryTest, TellsParametersAsThePageWantsThem) {
  json const reply = gallery.scenario("copper");
  EXPECT_EQ(reply.at("ok"), true);
  EXPECT_EQ(reply.at("name"), "copper");
  EXPECT_EQ(reply.at("text"), read(find_scenario("copper")));
  json const step = find(reply.at("parameters"), "path", "run.step");
  ASSERT_FALSE(step.is_null());
  std::set<std::string> keys;
  for (auto const& [key, value] : step.items()) keys.insert(key);
  EXPECT_EQ(keys, (std::set<std::string>{"path", "group", "name", "kind", "value", "unit", "base_unit", "units", "low",
                                         "high", "low_excluded", "words", "comment", "doc", "otherwise"}));
  EXPECT_EQ(step.at("group"), "run");
  EXPECT_EQ(step.at("unit"), "fs");
  EXPECT_EQ(step.at("base_unit"), "3.273 fs");  // 0.01 is 0.01 of these
  EXPECT_EQ(step.at("low"), 0);
  EXPECT_EQ(step.at("low_excluded"), true);
  EXPECT_TRUE(step.at("high").is_null());
  EXPECT_TRUE(step.at("doc").get<std::string>().starts_with("time step"));
  // Keys that its tables could have, too: once each, and none that is there.
  std::set<std::string> paths;
  for (auto const& one : reply.at("parameters")) EXPECT_TRUE(paths.insert(one.at("path")).second);
  for (auto const& one : reply.at("absent")) EXPECT_TRUE(paths.insert(one.at("path")).second) << one;
  json const skin = find(reply.at("absent"), "path", "run.skin");
  ASSERT_FALSE(skin.is_null());
  EXPECT_EQ(skin.at("value"), "");
  EXPECT_EQ(skin.at("otherwise"), "automatic");
  EXPECT_EQ(skin.at("units")[0], "angstrom");
  // One with a mistake still has its text.
  put("wrong.toml", small("w") + "[output]\ntrajectroy = 1\n");
  json const wrong = gallery.scenario("wrong");
  EXPECT_EQ(wrong.at("ok"), true);
  EXPECT_TRUE(wrong.at("parameters").empty());
  ASSERT_EQ(wrong.at("errors").size(), 1U);
  EXPECT_NE(wrong.at("errors")[0].at("message").get<std::string>().find("did you mean 'trajectory'"),
            std::string::npos);
  // What is no TOML, or no UTF-8, is refused.
  put("broken.toml", "title = \n");
  put("latin.toml", small("caf\xe9"));
  for (char const* name : {"broken", "latin"}) {
    json const broken = gallery.scenario(name);
    EXPECT_FALSE(broken.contains("ok"));
    EXPECT_EQ(broken.at("errors").size(), 1U);
    EXPECT_NO_THROW((void)broken.dump());
  }
  EXPECT_NE(gallery.scenario("coper").at("error").get<std::string>().find("did you mean 'copper'"), std::string::npos);
}

TEST_F(GalleryTest, ChecksAndSaysWhichValueIsWrong) {
  EXPECT_EQ(gallery.check("copper", json::object()).at("ok"), true);
  EXPECT_EQ(gallery.check("copper", nullptr).at("ok"), true);
  EXPECT_EQ(gallery.check("copper", {{"run.step", "0.02"}, {"run.steps", "10"}}).at("ok"), true);
  json const reply = gallery.check("copper", {{"run.step", "-1"}, {"box.boundary", "perodic"}, {"run.seed", "3"}});
  EXPECT_FALSE(reply.contains("ok"));
  ASSERT_EQ(reply.at("errors").size(), 2U);
  EXPECT_EQ(find(reply.at("errors"), "path", "run.step").at("message"),
            "step: -1 is out of range; it must be positive");
  EXPECT_NE(
      find(reply.at("errors"), "path", "box.boundary").at("message").get<std::string>().find("did you mean 'periodic'"),
      std::string::npos);
  EXPECT_NE(reply.at("error").get<std::string>().find("(and 1 more)"), std::string::npos);
  // What another value makes wrong has no path of its own.
  put("small.toml", small("s"));
  json const elsewhere = gallery.check("small", {{"box.high", "[0.5]"}, {"box.boundary", "mirror"}});
  ASSERT_EQ(elsewhere.at("errors").size(), 1U);
  EXPECT_TRUE(elsewhere.at("errors")[0].at("path").is_null()) << elsewhere.dump();
  // A line break in a value, a value that holds an equals sign, one path that is the beginning of another.
  EXPECT_EQ(gallery.check("small", {{"run.step", "1\n2"}}).at("errors")[0].at("path"), "run.step");
  EXPECT_EQ(gallery.check("small", {{"run.step", "a=b: c"}}).at("errors")[0].at("path"), "run.step");
  EXPECT_EQ(gallery.check("small", {{"run.steps", "-1"}}).at("errors")[0].at("path"), "run.steps");
  EXPECT_EQ(gallery.check("small", {{"nothing.here", "1"}}).at("errors")[0].at("path"), "nothing.here");
}

TEST_F(GalleryTest, RefusesWhatIsNoSet) {
  for (json const& set :
       {json(3), json::array({1}), json("run.step=1"), json{{"run.step", 1}}, json{{"", "1"}}, json{{"a=b", "1"}}}) {
    json const reply = gallery.check("copper", set);
    EXPECT_TRUE(reply.contains("error")) << set.dump();
    EXPECT_FALSE(reply.contains("ok"));
    EXPECT_TRUE(gallery.save("copper", set, "x", false).contains("error"));
    EXPECT_THROW(gallery.load("copper", set), Error);
  }
  EXPECT_TRUE(gallery.check("", {}).contains("error"));
  EXPECT_TRUE(gallery.check("../copper", {}).contains("error"));
  EXPECT_TRUE(gallery.check("/etc/passwd", {}).contains("error"));
  EXPECT_EQ(files(), 0U);
}

TEST_F(GalleryTest, SavesWithCommentsAndLayout) {
  json const reply = gallery.save("copper", {{"run.step", "0.02"}, {"title", "\"My copper\""}}, "my-copper", false);
  ASSERT_TRUE(reply.contains("ok")) << reply.dump();
  EXPECT_EQ(reply.at("path"), fs::absolute(folder / "my-copper.toml").string());
  std::string expected = read(find_scenario("copper"));
  auto const title = expected.find("title = ");
  expected.replace(title, expected.find('\n') - title, "title = \"My copper\"");
  auto const step = expected.find("\nstep = 0.01");
  ASSERT_NE(step, std::string::npos);
  expected.replace(step, 12, "\nstep = 0.02");
  EXPECT_EQ(read(folder / "my-copper.toml"), expected);
  EXPECT_EQ(files(), 1U);
  // It is a scenario like any other now.
  EXPECT_EQ(find(gallery.scenarios().at("scenarios"), "name", "my-copper").at("title"), "My copper");
  EXPECT_EQ(gallery.load("my-copper", {})->simulation->step_size(), 0.02);
  EXPECT_TRUE(gallery.save("my-copper", {{"run.steps", "1"}}, "twice", false).contains("ok"));
}

TEST_F(GalleryTest, ReplacesOnlyWhenTold) {
  ASSERT_TRUE(gallery.save("copper", {}, "mine", false).contains("ok"));
  std::string const first = read(folder / "mine.toml");
  json const refused = gallery.save("copper", {{"run.step", "0.02"}}, "mine", false);
  EXPECT_NE(refused.at("error").get<std::string>().find("already"), std::string::npos);
  EXPECT_EQ(read(folder / "mine.toml"), first);
  ASSERT_TRUE(gallery.save("copper", {{"run.step", "0.02"}}, "mine", true).contains("ok"));
  EXPECT_NE(read(folder / "mine.toml"), first);
  EXPECT_EQ(files(), 1U);
  // A link to elsewhere is replaced, not followed.
  fs::create_symlink(folder / "target", folder / "link.toml");
  EXPECT_TRUE(gallery.save("copper", {}, "link", false).contains("error"));
  EXPECT_TRUE(gallery.save("copper", {}, "link", true).contains("ok"));
  EXPECT_FALSE(fs::exists(folder / "target"));
}

TEST_F(GalleryTest, RefusesNamesThatLeadElsewhere) {
  for (std::string const bad : {"", ".", "..", "../x", "a/b", "/tmp/x", "a..b", ".hidden", "-x", "a\nb", "a\\b",
                                "copper", "copper.toml", "a\"b", "*"})
    EXPECT_TRUE(gallery.save("copper", {}, bad, true).contains("error")) << bad;
  EXPECT_TRUE(gallery.save("copper", {}, std::string("a\0b", 3), true).contains("error"));
  EXPECT_TRUE(gallery.save("copper", {}, std::string(200, 'a'), true).contains("error"));
  EXPECT_EQ(files(), 0U);
  EXPECT_TRUE(gallery.save("copper", {}, "Änderung 2, neu.toml", false).contains("ok"));
  EXPECT_TRUE(fs::exists(folder / "Änderung 2, neu.toml"));
}

TEST_F(GalleryTest, ResultsGoBelowThePresentFolder) {
  for (std::string const out : {"", "results", "results/copper-2", "Läufe/a b/c.d"})
    EXPECT_TRUE(gallery.check_run("copper", {}, out).contains("ok")) << out;
  for (std::string const out : {"/tmp/x", "../x", "results/../../x", "a//b", "a/", "./a", ".ssh", "a/.b", "-a", "a\nb"})
    EXPECT_EQ(gallery.check_run("copper", {}, out).value("error", "").substr(0, out.size() + 27),
              "'" + out + "' is no folder for results")
        << out;
  EXPECT_TRUE(gallery.check_run("copper", {}, std::string("a\0b", 3)).contains("error"));
  EXPECT_TRUE(gallery.check_run("copper", {{"run.step", "0"}}, "results").contains("errors"));
  // Kind: a name from outside that leads elsewhere. Siblings: files, links to folders and files, and those that lead nowhere.
  put("notes.txt", "mine");
  fs::create_directories(folder / "inside/deep");
  fs::create_directory_symlink(folder / "inside", folder / "near");
  fs::create_directory_symlink(fs::temp_directory_path(), folder / "far");
  fs::create_directory_symlink("../..", folder / "inside/up");
  fs::create_symlink(folder / "nowhere", folder / "lost");
  for (std::string const out :
       {"notes.txt", "notes.txt/x", "far", "far/x", "inside/up", "inside/up/x/y", "lost", "lost/x"})
    EXPECT_EQ(gallery.check_run("copper", {}, out).value("error", "").rfind("results can't go into '" + out + "': ", 0),
              0U)
        << out << gallery.check_run("copper", {}, out).dump();
  for (std::string const out : {"near", "near/x", "inside", "inside/deep/x"})
    EXPECT_TRUE(gallery.check_run("copper", {}, out).contains("ok")) << out;
  // No picture in place of a file.
  for (std::string const file : {"checkpoint.h5\\u0000.png", "../picture.png", "a\\u001b.png"})
    EXPECT_TRUE(gallery.check_run("copper", {{"output.pictures.0.file", "\"" + file + "\""}}, "").contains("errors"))
        << file;
}

// What is wrong in a file is quoted: a page may not have every file of the machine read.
TEST_F(GalleryTest, APageNamesFilesOfTheScenariosFolderOnly) {
  put("atoms.xyz", "1\n\nCu 1 0 0\n");
  std::string text = small("From a file");
  auto const at = text.find("load = ");
  put("filed.toml", text.substr(0, at) + "load = { kind = \"file\", path = \"atoms.xyz\" }\n");
  EXPECT_TRUE(gallery.check("filed", {{"run.steps", "5"}}).contains("ok"));
  EXPECT_TRUE(gallery.check("filed", {{"ensembles.atoms.load.path", "./atoms.xyz"}}).contains("ok"));
  for (std::string const path : {"/etc/passwd", "../secret.xyz", "a/../../b.xyz"}) {
    json const reply = gallery.check("filed", {{"ensembles.atoms.load.path", path}});
    EXPECT_EQ(reply.value("error", ""), "path: from a page only files in the folder of the scenario can be named")
        << path;
    EXPECT_TRUE(gallery.save("filed", {{"ensembles.atoms.load.path", path}}, "mine", true).contains("error")) << path;
    EXPECT_TRUE(gallery.check_run("filed", {{"ensembles.atoms.load.path", path}}, "").contains("error")) << path;
  }
  // Who wrote the file may.
  put("far.toml", text.substr(0, at) + "load = { kind = \"file\", path = \"" + (folder / "atoms.xyz") + "\" }\n");
  EXPECT_TRUE(gallery.check("far", {{"run.steps", "5"}}).contains("ok"));
}

TEST_F(GalleryTest, TellsKeysOfTheWordsThatAreSet) {
  std::string const range = "output.pictures.0.range";
  EXPECT_TRUE(find(gallery.scenario("copper").at("absent"), "path", range).is_null());
  json const right =
      gallery.check("copper", {{"output.pictures.0.drawing", "\"map\""}, {"run.skin", "\"2 angstrom\""}});
  EXPECT_TRUE(find(right.at("absent"), "path", "run.skin").is_null());
  EXPECT_FALSE(find(right.at("absent"), "path", "run.threads").is_null());
  EXPECT_FALSE(find(right.at("absent"), "path", range).is_null()) << right;
  // One that needs others, too, is wrong; what it could have is known all the same.
  json const wrong = gallery.check("copper", {{"influences.0.law", "\"morse\""}});
  EXPECT_TRUE(wrong.contains("error"));
  EXPECT_EQ(find(wrong.at("absent"), "path", "influences.0.a").at("otherwise"), "needed");
}

// 4 (r^-12 - r^-6) has its minimum -1 at 2^(1/6).
TEST_F(GalleryTest, DrawsWhatATypedLawSays) {
  std::string text = small("Typed");
  text.replace(text.find("[[1]]"), 5, "[[1], [2]]");
  put("typed.toml", text + "[[influences]]\non = \"atoms\"\nenergy = \"4*(1/r^12 - 1/r^6)\"\ncutoff = 4\n");
  json const curves = gallery.scenario("typed").at("curves");
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0].at("path"), "influences.0.energy");
  auto const distance = curves[0].at("distance").get<std::vector<double>>();
  auto const energy = curves[0].at("energy").get<std::vector<double>>();
  auto const force = curves[0].at("force").get<std::vector<double>>();
  ASSERT_EQ(distance.size(), energy.size());
  ASSERT_EQ(distance.size(), force.size());
  EXPECT_NEAR(distance.back(), 4, 1e-6);
  auto const least = static_cast<std::size_t>(std::min_element(energy.begin(), energy.end()) - energy.begin());
  EXPECT_NEAR(energy[least], -1, 0.002);
  EXPECT_NEAR(distance[least], std::pow(2, 1. / 6), 0.013);
  EXPECT_GT(force[least - 1], 0);
  EXPECT_LT(force[least + 1], 0);
  json const changed = gallery.check("typed", {{"influences.0.energy", "\"-1/r\""}}).at("curves");
  EXPECT_NEAR(changed[0].at("energy").back().get<double>(), -0.25, 1e-9);
  EXPECT_NEAR(changed[0].at("force").back().get<double>(), -0.0625, 1e-9);
  EXPECT_FALSE(gallery.check("typed", {{"influences.0.energy", "\"-1/\""}}).contains("curves"));
  put("small.toml", small("Small"));
  EXPECT_EQ(gallery.check("small", json::object()).at("curves"), json::array());
}

TEST_F(GalleryTest, AKeyThatIsSetStandsInTheSavedFileAndIsToldAsAnyOther) {
  json const set = {{"run.skin", "\"2 angstrom\""}, {"ensembles.atoms.load.jitter", "0.01"}};
  ASSERT_TRUE(gallery.save("copper", set, "mine", false).contains("ok"));
  json const mine = gallery.scenario("mine");
  for (auto const& [path, value] : set.items()) {
    EXPECT_EQ(find(mine.at("parameters"), "path", path).at("value"), value);
    EXPECT_TRUE(find(mine.at("absent"), "path", path).is_null());
  }
}

TEST_F(GalleryTest, AKeyIsLeftOut) {
  json const set = {{"run.cutoff", nullptr}, {"ensembles.atoms.diameter", nullptr}, {"run.steps", "7"}};
  json const checked = gallery.check("copper", set);
  ASSERT_TRUE(checked.contains("ok")) << checked.dump();
  EXPECT_FALSE(find(checked.at("absent"), "path", "run.cutoff").is_null());
  ASSERT_TRUE(gallery.save("copper", set, "mine", false).contains("ok"));
  std::string expected = read(find_scenario("copper"));
  for (std::string const line : {"cutoff = \"7.653 angstrom\"          # 3 r0\n", "diameter = \"2.2 angstrom\"\n"})
    expected.erase(expected.find(line), line.size());
  expected.replace(expected.find("steps = 2000"), 12, "steps = 7");
  EXPECT_EQ(read(folder / "mine.toml"), expected);
  // One that is needed is wrong where it was.
  json const needed = gallery.check("copper", {{"run.step", nullptr}, {"ensembles.atoms.mass", nullptr}});
  ASSERT_TRUE(needed.contains("errors")) << needed.dump();
  EXPECT_FALSE(find(needed.at("errors"), "path", "run.step").is_null()) << needed.dump();
}

// Kind of fault: the form helps with another law than the one that is chosen. Siblings: keys that are there, keys that are
// missing and needed, their units, messages, and a law that is chosen back.
TEST_F(GalleryTest, HelpIsThatOfTheLawThatIsChosen) {
  put("argon.toml",
      "[units]\nbase = \"custom\"\nlength = \"1 angstrom\"\nmass = \"1 amu\"\ntime = \"1 ps\"\n[box]\nlow = [0, 0]\n"
      "high = [20, 20]\nboundary = \"periodic\"\n[run]\nstep = \"1 fs\"\nsteps = 3\ncutoff = 8\n[[ensembles]]\n"
      "name = \"atoms\"\nclass = \"Newton\"\nmass = 40\nload = { kind = \"positions\", positions = [[1, 1], [5, 5]] }\n"
      "[[influences]]\nlaw = \"lennard-jones\"\non = \"atoms\"\ndepth = \"0.01 eV\"\nr0 = \"3.8 angstrom\"\n");
  json const refused = gallery.check("argon", {{"influences.0.law", "\"morse\""}});
  ASSERT_TRUE(refused.contains("errors")) << refused;
  for (auto const& one : refused.at("errors")) {
    EXPECT_EQ(one.at("message").get<std::string>().find(folder.path), std::string::npos) << one;
    EXPECT_EQ(one.at("path"), "influences.0.a") << one;
    EXPECT_NE(one.at("message").get<std::string>().find("a = \"1 1/angstrom\""), std::string::npos) << one;
  }
  json const a = find(refused.at("absent"), "path", "influences.0.a");
  ASSERT_FALSE(a.is_null());
  EXPECT_EQ(a.at("otherwise"), "needed");
  EXPECT_EQ(a.at("unit"), "1/angstrom");
  EXPECT_NE(a.at("doc").get<std::string>().find("steepness"), std::string::npos);
  EXPECT_EQ(find(refused.at("parameters"), "path", "influences.0.r0").at("doc"), "distance of the minimum");
  json const good = gallery.check("argon", {{"influences.0.law", "\"morse\""}, {"influences.0.a", "\"2 1/angstrom\""}});
  ASSERT_TRUE(good.contains("ok")) << good;
  EXPECT_NE(find(good.at("parameters"), "path", "influences.0.a").at("doc").get<std::string>().find("steepness"),
            std::string::npos);
  json const rydberg = gallery.check("argon", {{"influences.0.law", "\"rydberg\""}});
  EXPECT_EQ(find(rydberg.at("absent"), "path", "influences.0.a").at("unit"), "");
}

TEST_F(GalleryTest, SavesNothingThatIsWrong) {
  json const reply = gallery.save("copper", {{"run.step", "0"}}, "wrong", false);
  ASSERT_EQ(reply.at("errors").size(), 1U);
  EXPECT_EQ(reply.at("errors")[0].at("path"), "run.step");
  // A file beside the scenario that would not be beside the copy.
  fs::create_directory(folder / "other");
  std::string text = small("f");
  text.replace(text.find("{ kind"), std::string::npos, "{ kind = \"file\", path = \"atoms.xyz\" }\n");
  std::ofstream(folder / "there.toml") << text;
  std::ofstream(folder / "atoms.xyz") << "1\n\nX 1 0 0\n";
  EXPECT_TRUE(gallery.save("there", {}, "copy", false).contains("ok"));
  fs::remove(folder / "atoms.xyz");
  EXPECT_TRUE(gallery.save("there", {}, "copy2", false).contains("error"));
  EXPECT_FALSE(fs::exists(folder / "copy2.toml"));
  Gallery const nowhere(folder / "not there");
  EXPECT_TRUE(nowhere.save("copper", {}, "x", false).contains("error"));
  EXPECT_EQ(nowhere.scenarios().at("scenarios").size(), shipped_scenarios().size());
}

TEST_F(GalleryTest, RenamesAnEnsembleWithItsOtherValues) {
  put("small.toml", small("s"));
  json const set = {
      {"ensembles.atoms.name", "\"balls\""}, {"ensembles.atoms.mass", "2"}, {"ensembles.atoms.class", "\"Newton\""}};
  auto const scenario = gallery.load("small", set);
  EXPECT_EQ(scenario->ensembles[0]->name(), "balls");
  ASSERT_TRUE(gallery.save("small", set, "balls", false).contains("ok"));
  EXPECT_EQ(gallery.load("balls", {})->ensembles[0]->column(scenario->ensembles[0]->field("mass"))[0], 2);
}

TEST_F(GalleryTest, PicturesAreThoseOfTheFolderAlone) {
  for (std::string const bad : {"/gallery/", "/gallery/.png", "/gallery/../gallery/copper.png", "/gallery/copper",
                                "copper.png", "/gallery//etc/passwd.png", "/gallery/%2e%2e/x.png",
                                "/gallery/nothing.png", "", "/gallery/copper.toml", "/gallery/copper.png/"})
    EXPECT_FALSE(gallery.picture(bad)) << bad;
  EXPECT_FALSE(gallery.picture(std::string_view("/gallery/\0.png", 14)));
  std::size_t bytes = 0;
  for (auto const& entry : fs::directory_iterator(gallery_folder())) bytes += entry.file_size();
  EXPECT_LT(bytes, 1'500'000U);
}

TEST_F(GalleryTest, PicturesCanBeAskedForMeanwhile) {
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (int k = 0; k < 50; ++k) EXPECT_TRUE(gallery.picture("/gallery/copper.png"));
    });
  for (int k = 0; k < 5; ++k) gallery.scenarios();
  for (auto& thread : threads) thread.join();
}

}  // namespace
}  // namespace boltzmann::gallery_test
