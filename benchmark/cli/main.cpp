// SPDX-License-Identifier: MIT
#include "benchmark/harness.h"

int main(int argc, char** argv) {
  return raymoval::run_command_line(argc, argv);
}
