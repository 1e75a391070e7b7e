// SPDX-License-Identifier: MIT
// Programs here are shell scripts of a line or two, so that all they do can be seen.
#include "methods/external/external.h"

#include <catch2/catch.hpp>
#include <csignal>
#include <thread>

#include "core/files/files.h"
#include "core/files/part_name.h"
#include "core/files/scratch_folder.h"
#include "methods/registry.h"
#include "tests/datasets/temporary_folder.h"
#include "tests/methods/toy_world.h"

namespace raymoval::external_test {
using test::message_of;

namespace {

/// Three scans of 2, 1 and 0 points, the sensor one metre further each time.
toy::HeldScans tiny_scans() {
  toy::HeldScans scans;
  for (int i = 0; i < 3; ++i) {
    Scan scan;
    scan.name = "secret";
    scan.time_s = 0.1 * i;
    scan.T_world_sensor = Eigen::Translation3d(i, 0.0, 0.0);
    if (i == 0) scan.points = {{1, 2, 3}, {4, 5, 6}};
    if (i == 1) scan.points = {{7, 8, 9}};
    if (i == 0) scan.reflectance = {0.5F, 0.25F};
    scans.add_scan(std::move(scan));
  }
  return scans;
}

constexpr const char* kRight =
    "cd predictions; printf '\\373\\0\\0\\0\\011\\0\\0\\0' > 000000.label; "
    "printf '\\011\\0\\003\\0' > 000001.label; : > 000002.label; cd ..; ";

/// A program, its manifest, and a folder for temporary files of its own.
struct Fixture {
  test::TemporaryFolder here, temporary;
  toy::HeldScans scans = tiny_scans();

  Fixture() { ::setenv("TMPDIR", temporary.text().c_str(), 1); }
  ~Fixture() { ::unsetenv("TMPDIR"); }

  std::string manifest(const std::string& script, const std::string& more = "",
                       const std::string& command = R"(["/bin/sh", "{here}/program.sh"])") const {
    (void)here.write("program.sh", script);
    return here
        .write("manifest.json", R"({"name": "own", "sentence": "Tests.", "version": "3",
          "online": true, "command": )" +
                                    command + more + "}")
        .string();
  }
  [[nodiscard]] static ConfiguredMethod configured(const std::string& path) {
    return MethodRegistry::built_in().configure("external:" + path);
  }
  [[nodiscard]] MaskStore masks(const std::string& script, const std::string& more = "") const {
    return toy::masks_of(*configured(manifest(script, more)).make(), scans);
  }
  [[nodiscard]] std::string fault(const std::string& script, const std::string& more = "") const {
    return message_of<MethodError>([&] { (void)masks(script, more); });
  }
  [[nodiscard]] bool nothing_left() const {
    return std::filesystem::is_empty(std::filesystem::path(temporary.text()));
  }
  [[nodiscard]] std::string seen(const std::string& file) const {
    return read_text(here / ("seen/" + file));
  }
};

bool is_running(const std::string& pid) {
  std::ifstream stat("/proc/" + pid + "/stat");
  std::string number, name, state;
  return (stat >> number >> name >> state) && state != "Z" && state != "X";
}

}  // namespace

TEST_CASE("an external program gets files and its answer is taken bit by bit") {
  const Fixture f;
  const std::string copy = "cp -r . \"$(dirname \"$0\")/seen\"; ";
  const MaskStore masks = f.masks(copy + kRight, R"(, "parameters": [
      {"name": "size", "default": 0.5, "sentence": "A."},
      {"name": "count", "default": 3, "sentence": "B."},
      {"name": "way", "default": "up", "choices": ["up", "down"], "sentence": "C."}])");
  // 251 and 9; 9 with an instance in the upper half; nothing for no point.
  CHECK(masks.get(0) == Mask{1, 0});
  CHECK(masks.get(1) == Mask{0});
  CHECK(masks.get(2).empty());
  CHECK(f.seen("velodyne/000000.bin") == test::floats({1, 2, 3, 0.5F, 4, 5, 6, 0.25F}));
  CHECK(f.seen("velodyne/000001.bin") == test::floats({7, 8, 9, 0}));
  CHECK(f.seen("velodyne/000002.bin").empty());
  CHECK(f.seen("poses.txt") ==
        "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n1 0 0 2 0 1 0 0 0 0 1 0\n");
  CHECK(f.seen("times.txt") == "0\n0.1\n0.2\n");
  CHECK_THAT(f.seen("calib.txt"), Catch::Contains("Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n"));
  CHECK_THAT(f.seen("parameters.json"), Catch::Contains("\"size\": 0.5") &&
                                            Catch::Contains("\"count\": 3") &&
                                            Catch::Contains("\"way\": \"up\""));
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(f.here / "seen")) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  // Nothing else: no label, no name of the data set.
  CHECK(names == std::vector<std::string>{"calib.txt", "parameters.json", "poses.txt",
                                          "predictions", "sensor.json", "sequence.json",
                                          "times.txt", "velodyne"});
  CHECK(f.nothing_left());
}

TEST_CASE("a faulty program is told by file, expectation and finding, and leaves nothing") {
  const Fixture f;
  const std::string right = kRight;
  struct Fault {
    std::string script;
    std::vector<std::string> says;
  };
  const std::vector<Fault> faults = {
      {"true", {"predictions/000000.label: missing", "expected 3 files", "found 0"}},
      {right + "rm predictions/000001.label", {"predictions/000001.label: missing", "found 2"}},
      {right + ": > predictions/000003.label", {"000003.label: belongs to no scan", "found 4"}},
      {right + "printf 1234 >> predictions/000000.label", {"000000.label", "8 bytes", "found 12"}},
      {right + "printf '\\001\\0\\0\\0' > predictions/000001.label",
       {"000001.label: point 0 has label 1", "9 (kept) or 251 (removed)"}},
      {right + "rm predictions/000001.label; mkfifo predictions/000001.label",
       {"000001.label: expected a file"}},
      {right + "rm -r predictions", {"predictions: cannot be read"}},
      {"echo out; echo no luck >&2; exit 3", {"exit code 3", "out\nno luck"}},
      {"kill -SEGV $$", {"signal 11", "printed nothing"}},
      {"exec 2>&1; yes | head -c 100000; echo the end; exit 1", {"y\nthe end"}},
  };
  for (const Fault& fault : faults) {
    INFO(fault.script);
    const std::string message = f.fault(fault.script);
    test::check_says(message, fault.says);
    CHECK(message.size() < 5000);
    CHECK(f.nothing_left());
  }
}

TEST_CASE("a program that hangs, is missing or needs too much disk is an error") {
  const Fixture f;
  test::check_says(f.fault("echo before; sleep 600", R"(, "time_limit_s": 1.5)"),
                   {"did not end within 1.5 s", "before"});
  // Three points take 60 bytes; 1e-8 GiB are 10.7.
  test::check_says(f.fault(kRight, R"(, "disk_limit_gib": 1e-8)"), {"disk_limit_gib"});
  for (const char* command : {R"(["raymoval-no-such-program"])", R"(["{here}/none"])",
                              R"(["{here}/program.sh"])"}) {  // Not executable.
    const auto method = Fixture::configured(f.manifest(kRight, "", command));
    CHECK_THROWS_AS(toy::masks_of(*method.make(), f.scans), MethodError);
  }
  CHECK(f.nothing_left());
}

TEST_CASE("a cancelled program ends with all that it started") {
  const Fixture f;
  const auto method = Fixture::configured(f.manifest(
      "sleep 600 & echo $! > \"$(dirname \"$0\")/child\"; echo $$ > \"$(dirname \"$0\")/own\"; "
      "wait"));
  std::atomic<bool> stop{false};
  RunContext context;
  context.cancel = &stop;
  std::thread canceller([&] {
    while (!std::filesystem::exists(f.here / "own") || read_text(f.here / "own").empty()) {
      std::this_thread::yield();
    }
    stop = true;
  });
  toy::Masks masks(f.scans.size());
  CHECK_THROWS_AS(method.make()->run(f.scans, masks, context), Cancelled);
  canceller.join();
  for (const char* file : {"own", "child"}) {
    std::string pid = read_text(f.here / file);
    pid.pop_back();
    // It ends some time after the signal.
    for (int round = 0; round < 1000 && is_running(pid); ++round) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    CHECK_FALSE(is_running(pid));
  }
  CHECK(f.nothing_left());
}

TEST_CASE("what a killed run left is removed, what a running one has is not") {
  const Fixture f;
  const auto target = f.temporary / "raymoval-external";
  const Part alive = new_part_folder(target);
  (void)f.temporary.write("other/file", "");
  std::filesystem::path dead;
  {
    const Part ended = new_part_folder(target);
    dead = ended.place;
    write_atomically(dead / "000000.bin", "1234");
  }
  (void)f.masks(kRight);
  CHECK(std::filesystem::exists(dead));  // It was none when this process looked there.
  remove_abandoned_scratch_folders();
  CHECK_FALSE(std::filesystem::exists(dead));
  CHECK(std::filesystem::exists(alive.place));
  CHECK(std::filesystem::exists(f.temporary / "other/file"));
}

TEST_CASE("a program that fills its folder is ended, by whatever files") {
  const Fixture f;
  // 0.02 GiB are 20.48 MiB.
  const std::string fault =
      f.fault("echo before; mkdir deep; head -c 30000000 /dev/urandom >deep/file; sleep 600",
              R"(, "disk_limit_gib": 0.02)");
  test::check_says(fault, {"more than 0.02 GiB", "'disk_limit_gib'", "before"});
  CHECK(f.nothing_left());
}

TEST_CASE("the program is told how many threads it may use, and arguments stay whole") {
  const Fixture f;
  ::setenv("RAYMOVAL_TEST_WORD", "two words", 1);
  const auto method = Fixture::configured(
      f.manifest("printf '%s|' \"$@\" \"$OMP_NUM_THREADS\" > \"$(dirname \"$0\")/told\"; " +
                     std::string(kRight),
                 "",
                 R"(["/bin/sh", "{here}/program.sh", "a b; exit 1", "{RAYMOVAL_TEST_WORD|x}",
                     "-{RAYMOVAL_TEST_UNSET|usual}-"])"));
  (void)toy::masks_of(*method.make(), f.scans, 2);
  CHECK(read_text(f.here / "told") == "a b; exit 1|two words|-usual-|2|");
}

TEST_CASE("the version changes with the manifest and the program and with nothing else") {
  const Fixture f;
  const auto version = [&](const std::string& script, const std::string& more) {
    return Fixture::configured(f.manifest(script, more)).entry->version;
  };
  const std::string listed = R"(, "files": ["parts"])";
  (void)f.here.write("parts/one", "1");
  const std::string first = version("true", listed);
  CHECK_THAT(first, Catch::StartsWith("3+"));
  CHECK(version("true", listed) == first);
  (void)f.here.write("unlisted", "1");
  (void)f.here.write("parts/__pycache__/one.pyc", "1");
  CHECK(version("true", listed) == first);
  CHECK(version("true ", listed) != first);
  CHECK(version("true", listed + " ") != first);
  (void)f.here.write("parts/two", "2");
  CHECK(version("true", listed) != first);
}

TEST_CASE("an external method is configured as others are, under the manifest's name") {
  const Fixture f;
  ConfiguredMethod copy;
  {
    const ConfiguredMethod method = Fixture::configured(f.manifest(
        "true", R"(, "parameters": [{"name": "size", "default": 0.5, "unit": "m", "minimum": 0,
                   "sentence": "A."}])"));
    copy = method;
  }
  CHECK(copy.full_name() == "own:default");
  CHECK(copy.variant.online);
  CHECK(copy.entry->parameters.at(0).notes.unit == "m");
  CHECK(MethodRegistry::built_in().configure(copy.address()).entry->version == copy.entry->version);
  CHECK(MethodRegistry::built_in().configure("raymoval").address() == "raymoval:offline");
  const auto numbered = f.here.write("numbered.json", R"({"name": "own", "sentence": "s",
      "version": 2, "online": true, "command": ["true"]})");
  CHECK_THAT(Fixture::configured(numbered.string()).entry->version, Catch::StartsWith("2+"));
}

TEST_CASE("a manifest that is not right is refused with the remedy") {
  const Fixture f;
  const auto refused = [&](const std::string& content) {
    const std::string path = f.here.write("manifest.json", content).string();
    return message_of<ConfigurationError>([&] { (void)Fixture::configured(path); });
  };
  const std::string good =
      R"("sentence": "s", "version": "1", "online": true, "command": ["true"])";
  const std::string own = R"({"name": "own", )" + good;
  const auto parameter = [&](const std::string& text) {
    return refused(own + R"(, "parameters": [)" + text + "]}");
  };
  test::check_says(refused(own + R"(, "comand": []})"), {"'comand'", "Did you mean 'command'"});
  test::check_says(refused(R"({"name": "noop", )" + good + "}"), {"'noop'", "another one"});
  test::check_says(refused(R"({"name": "a/b", )" + good + "}"), {"'a/b'"});
  test::check_says(refused("{" + good + "}"), {"'name' is missing"});
  test::check_says(refused(R"({"name": "own", "sentence": "s", "version": "1"})"),
                   {"'online' is missing"});
  test::check_says(
      refused(R"({"name": "o", "sentence": "s", "version": "1", "online": true, "command": []})"),
      {"'command'"});
  test::check_says(refused(R"({"name": "o", "sentence": "s", "version": "1", "online": true,
                              "command": ["{hre}/a"]})"),
                   {"{hre}", "{here}"});
  test::check_says(refused("[]"), {"expected an object"});
  test::check_says(refused("{,"), {"line 1"});
  test::check_says(parameter(R"({"name": "a", "default": 2, "maximum": 1, "sentence": "s"})"),
                   {"parameters[0]", "out of range"});
  test::check_says(parameter(R"({"name": "a", "sentence": "s"})"), {"'default' is missing"});
  const std::string fine = R"({"name": "a", "default": 2, "sentence": "s"})";
  test::check_says(parameter(fine + ", " + fine), {"parameters[1]", "two parameters"});
  test::check_says(message_of<ConfigurationError>([] { (void)Fixture::configured("/none.json"); }),
                   {"/none.json", "no such manifest"});
  test::check_says(message_of<ConfigurationError>([] { (void)Fixture::configured(""); }),
                   {"external: names no manifest", "external:PATH"});
  CHECK_THROWS_AS(Fixture::configured(f.manifest("true", R"(, "files": ["none"])")), DataError);
}

}  // namespace raymoval::external_test
