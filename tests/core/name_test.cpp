// SPDX-License-Identifier: MIT
#include "core/name.h"

#include <fcntl.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "core/terminal_colour.h"
#include "core/utf8.h"

using namespace raymoval;

TEST_CASE("names that some reader would take for something else are refused") {
  const std::vector<std::string> hostile = {"",
                                            ".",
                                            "..",
                                            ".hidden",
                                            "a/b",
                                            "a\\b",
                                            "../up",  // Paths.
                                            "=cmd|' /C calc'!A0",
                                            "+1+1",
                                            "-1",
                                            "@SUM(A1)",
                                            "--help",  // Formulas, options.
                                            " =1",
                                            " [2pt]",
                                            "a ",
                                            " ",  // Blanks around.
                                            "\x1b[31mred",
                                            "a\x1b]0;title\x07",
                                            "a\rb",
                                            "a\nb",
                                            "a\tb",  // Terminals.
                                            "\x07",
                                            "a\x7f",
                                            "\xc2\x9b"
                                            "31m",
                                            "\xc2\x85",
                                            std::string("a\0b", 3),
                                            "\xe2\x80\xae"
                                            "gpj.exe",
                                            "a\xe2\x80\x8b"
                                            "b",
                                            "\xef\xbb\xbf"
                                            "a",  // Unseen.
                                            "\xe2\x81\xa6"
                                            "a",
                                            "a\xe2\x80\xa8"
                                            "b",
                                            "a\xc2\xad"
                                            "b",
                                            "\xf3\xa0\x81\x81",
                                            "\xff",
                                            "a\xc0\xaf",
                                            "\xed\xa0\x80",
                                            "a\xe2\x80",  // No UTF-8.
                                            std::string(201, 'a')};
  for (const std::string& name : hostile) {
    INFO(printable_text(name));
    CHECK_FALSE(name_problem(name).empty());
  }
}

TEST_CASE("nothing but line breaks and tabs reaches a log") {
  std::FILE* const log = std::tmpfile();  // No terminal.
  REQUIRE(log != nullptr);
  const auto shown = [&](const std::string& text) { return terminal_text(text, log); };
  CHECK(shown("a\tb\nc \xc3\xa9") == "a\tb\nc \xc3\xa9");
  CHECK(shown("\x1b[1;31mred\x1b[0m") == " [1;31mred [0m");
  CHECK(shown("\x1b[2J\x1b[31") == " [2J [31");
  CHECK(shown("\x1b]0;title\x07"
              "a") == " ]0;title a");
  CHECK(shown("a\rb\bc\x7f") == "a b c\xef\xbf\xbd");
  CHECK(shown("\xc2\x9b"
              "2J") ==
        "\xef\xbf\xbd\xef\xbf\xbd"
        "2J");
  CHECK(shown("\xe2\x80\xae"
              "x")
            .find("\xe2\x80\xae") == std::string::npos);
  CHECK(shown("\x1b") == " ");
  CHECK(shown("").empty());
  std::fclose(log);
}

// `script` has no place in the tests, so a terminal of our own is opened.
TEST_CASE("a terminal gets the program's colours and no other sequence") {
  const int main_end = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (main_end < 0 || ::grantpt(main_end) != 0 || ::unlockpt(main_end) != 0) return;
  std::FILE* const terminal = std::fopen(::ptsname(main_end), "w");
  if (terminal == nullptr) return;
  ::setenv("TERM", "xterm", 1);
  ::unsetenv("NO_COLOR");
  const std::string red = in_red("red", terminal);
  CHECK(red != "red");
  CHECK(terminal_text(red + "\n", terminal) == red + "\n");
  CHECK(terminal_text("\x1b[8mhidden\x1b[2J\x1b[31mx", terminal) == " [8mhidden [2J [31mx");
  std::fclose(terminal);
  ::close(main_end);
}
