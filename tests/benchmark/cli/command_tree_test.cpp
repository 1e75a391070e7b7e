// SPDX-License-Identifier: MIT
#include "benchmark/cli/shell/command_tree.h"

#include <catch2/catch.hpp>

#include "benchmark/cli/shell/completion.h"
#include "benchmark/cli/shell/manual_page.h"
#include "core/error.h"

using namespace raymoval;

namespace {

using Words = std::vector<std::string>;

/// A program with one command: an option with named values, one that repeats, a flag, a short name,
/// an option that --help hides, and a word.
struct SmallProgram {
  std::string format, output, word, place;
  std::vector<std::string> methods;
  bool quiet = false;
  CommandParser parser{"small: draws. It does nothing else.", "small"};

  SmallProgram() {
    CommandOptions draw = parser.add_command("draw", "Draws it's own [things]");
    draw.add("run", "RUN", word, "Run folder");
    draw.add("--format", "FORMAT", format, "md (default), csv or tex");
    draw.add("--method", "NAME", methods, "Method");
    draw.add("-o,--output", "FILE", output, "Where to");
    draw.add("place,--sequence", "PATH", place, "Sequence");
    draw.add_flag("--quiet", quiet, "No progress");
    draw.set_footer("A sentence.\nExamples:\n  small draw '.x' -o a\\b\nThe end.");
    parser.add_command("secret", "").hide();
  }
};

const OptionText& option(const CommandText& command, const std::string& name) {
  for (const OptionText& found : command.options) {
    if (found.long_name == name) return found;
  }
  throw InternalError("no option " + name);
}

}  // namespace

TEST_CASE("the values of an option are the words that its sentence names first", "[cli]") {
  CHECK(words_named_first("md (default), csv, tex or json") == Words{"md", "csv", "tex", "json"});
  CHECK(words_named_first("skewed or corrected: a scan is taken while the sensor moves") ==
        Words{"skewed", "corrected"});
  CHECK(words_named_first("map, pr-rr or stages; the last two are charts") ==
        Words{"map", "pr-rr", "stages"});
  CHECK(words_named_first("Metres; points beyond are not evaluated").empty());
  CHECK(words_named_first("").empty());
}

TEST_CASE("the command tree has what --help shows and nothing else", "[cli]") {
  const SmallProgram program;
  const CommandTree tree = command_tree(program.parser, MethodRegistry::built_in());
  REQUIRE(tree.commands.size() == 1);
  const CommandText& draw = tree.commands.front();
  CHECK(draw.name == "draw");
  CHECK(draw.options.size() == 6);  // With --help.
  CHECK(option(draw, "--method").repeats);
  CHECK(option(draw, "--method").value_set == "methods");
  CHECK_FALSE(option(draw, "--output").repeats);
  CHECK(option(draw, "--output").short_name == "-o");
  CHECK(option(draw, "--output").value_set == "files");
  CHECK(option(draw, "--quiet").value_set.empty());
  CHECK(option(draw, "--format").value_set == "draw_format");
  REQUIRE(draw.words.size() == 2);
  CHECK(draw.words.front().value == "RUN");
  CHECK(draw.words.back().value == "PATH");  // It may stand alone or behind its option.
  CHECK(draw.words.back().long_name.empty());
  CHECK(option(draw, "--sequence").value_set == "sequences");
}

TEST_CASE("signs that a shell or troff would take for its own are protected", "[cli]") {
  const SmallProgram program;
  const CommandTree tree = command_tree(program.parser, MethodRegistry::built_in());
  CHECK(completion_script(tree, "zsh").find(R"('draw:Draws it'\''s own [things]')") !=
        std::string::npos);
  CHECK(completion_script(tree, "fish").find(R"(-d 'Draws it\'s own [things]')") !=
        std::string::npos);
  const std::string page = manual_page(tree);
  CHECK(page.find("small draw \\(aq.x\\(aq \\-o a\\eb") != std::string::npos);
  CHECK(page.find("secret") == std::string::npos);
  CHECK_THROWS_AS(completion_script(tree, "tcsh"), UsageError);
}
