// SPDX-License-Identifier: MIT
#include "benchmark/cli/command_line.h"

int main(int argc, char** argv) {
  return raymoval::run_command_line(argc, argv);
}
