// SPDX-License-Identifier: MIT
// The program with methods that do what methods must not do, to see that a run survives them. It
// is also an example of a program with methods of its own.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include "benchmark/harness.h"
#include "methods/controls/controls.h"

namespace {

using raymoval::Scan;

using Deed = std::function<void()>;

/// Does its deed at the second scan, and else keeps every second point.
class Faulty : public raymoval::Remover {
 public:
  Faulty(Deed deed, double milliseconds) : deed_(std::move(deed)), pause_(milliseconds * 1e-3) {}

  void run(const raymoval::ScanSource& scans, raymoval::RemovalSink& sink,
           const raymoval::RunContext& context) override {
    context.begin_pass("combing", scans.size());
    for (std::size_t i = 0; i < scans.size(); ++i) {
      if (i == 1) deed_();
      std::this_thread::sleep_for(pause_);
      raymoval::Mask mask(scans.load(i).size(), 0);
      for (std::size_t k = 0; k < mask.size(); k += 2) mask[k] = 1;
      sink.accept(i, mask);
      context.advance();
    }
  }

 private:
  Deed deed_;
  std::chrono::duration<double> pause_;
};

void leak() {
  std::fputs("about to leak\n", stderr);
  for (;;) {
    // Volatile, else a compiler may leave the block out.
    const volatile char* block = (new std::vector<char>(8 << 20, 'x'))->data();
    std::this_thread::sleep_for(std::chrono::milliseconds(block[0] == 'x' ? 2 : 0));
  }
}

/// Leaves the work to a child that leaks, as a method in another language would.
void leak_in_child() {
  if (::fork() == 0) leak();
  ::pause();
}

/// Lets a test change data or programs in the middle of a run.
void meddle() {
  const char* command = std::getenv("FAULTY_COMMAND");
  if (command != nullptr && std::system(command) != 0) std::abort();
}

void hang() {
  ::fork();  // Its child hangs too.
  for (;;) ::pause();
}

/// Starts a program that leaves its session.
void stray() {
  if (::fork() == 0) ::setsid();
  for (;;) ::pause();
}

void crash() {
  std::puts("the last words");
  std::fflush(stdout);
  std::signal(SIGSEGV, SIG_DFL);  // A sanitizer would catch it.
  std::raise(SIGSEGV);
}

void chatter() {
  for (int i = 0; i < 100000; ++i) std::fprintf(stderr, "line %d\n", i);
  std::abort();
}

/// Passes on another method's answer, except for one in a hundred of the removed points.
class Slipping : public raymoval::Remover {
 public:
  explicit Slipping(std::unique_ptr<raymoval::Remover> method) : method_(std::move(method)) {}

  void run(const raymoval::ScanSource& scans, raymoval::RemovalSink& sink,
           const raymoval::RunContext& context) override {
    Sieve sieve(sink);
    method_->run(scans, sieve, context);
  }

 private:
  class Sieve : public raymoval::RemovalSink {
   public:
    explicit Sieve(raymoval::RemovalSink& sink) : sink_(sink) {}
    void accept(std::size_t scan, const raymoval::Mask& mask) override {
      raymoval::Mask slipped = mask;
      std::size_t removed = 0;
      for (std::uint8_t& flag : slipped) {
        if (flag != 0 && ++removed % 100 == 0) flag = 0;
      }
      sink_.accept(scan, slipped);
    }

   private:
    raymoval::RemovalSink& sink_;
  };

  std::unique_ptr<raymoval::Remover> method_;
};

/// The methods of raymoval itself, of which the one called FAULTY_SLIP loses some removals.
void add_real_methods(raymoval::MethodRegistry& methods) {
  const char* slip = std::getenv("FAULTY_SLIP");
  for (const auto& entry : raymoval::MethodRegistry::built_in().entries()) {
    raymoval::MethodEntry added = *entry;
    if (slip != nullptr && added.name == slip) {
      added.make = [make = entry->make](const raymoval::Configuration& values) {
        return std::make_unique<Slipping>(make(values));
      };
    }
    methods.add(added);
  }
}

raymoval::MethodEntry entry_of(const std::string& name, const Deed& deed) {
  raymoval::MethodEntry entry = raymoval::noop_entry();
  entry.name = name;
  // Raised by a test, to see that results of an older version are not used.
  if (const char* version = std::getenv("FAULTY_VERSION")) entry.version = version;
  entry.parameters = {{"milliseconds", 0.0, {.minimum = 0.0, .maximum = 1000.0}, {}}};
  entry.make = [deed](const raymoval::Configuration& values) {
    return std::make_unique<Faulty>(deed, std::get<double>(values.front().second));
  };
  return entry;
}

}  // namespace

int main(int argc, char** argv) {
  raymoval::MethodRegistry methods;
  add_real_methods(methods);
  methods.add(entry_of("comb", [] {}));
  methods.add(entry_of("comb2", [] {}));
  methods.add(entry_of("crash", crash));
  methods.add(entry_of("abort", chatter));
  methods.add(entry_of("quit", [] { std::exit(0); }));
  methods.add(entry_of("quit7", [] { std::_Exit(7); }));
  methods.add(entry_of("meddle", meddle));
  methods.add(entry_of("hang", hang));
  methods.add(entry_of("stray", stray));
  methods.add(entry_of("leak", leak));
  methods.add(entry_of("leak-child", leak_in_child));
  methods.add(entry_of("killed", [] { std::raise(SIGKILL); }));
  methods.add(entry_of("throw", [] { throw std::runtime_error("no idea"); }));
  return raymoval::run_command_line(argc, argv, methods);
}
