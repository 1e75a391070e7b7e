// SPDX-License-Identifier: MIT
// Whether every method gives the same answer for any number of threads, on data of real size:
//
//   raymoval_threads SEQUENCE [FIRST:LAST [METHOD...]]
//
// Runs every variant of every method (or of the named methods), and each method with every switch
// turned and every choice made, with 1, 2, 3 and 8 threads, on any number of processors. Exit code
// 1 if a mask or a reason differs. scripts/threads.sh runs it.
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <iostream>

#include "benchmark/process/method_run.h"
#include "core/parameter_condition.h"
#include "core/text.h"
#include "datasets/clouds/frames.h"
#include "datasets/open_sequence.h"

namespace {

using namespace raymoval;

constexpr int kThreads[] = {2, 3, 8};

MethodRequest request_for(const ConfiguredMethod& method, const std::string& name) {
  MethodRequest request;
  request.name = name;
  request.method = method;
  return request;
}

/// The values of a switch or a choice other than the present value.
std::vector<ParameterValue> other_values(const ParameterSpec& spec, const ParameterValue& present) {
  std::vector<ParameterValue> values;
  if (const bool* flag = std::get_if<bool>(&present)) values.emplace_back(!*flag);
  for (const std::string& choice : spec.choices) {
    if (ParameterValue(choice) != present) values.emplace_back(choice);
  }
  return values;
}

/// The default variant of a method with one switch or choice at a time set otherwise.
void add_switched(const MethodEntry& entry, std::vector<MethodRequest>& requests) {
  const ConfiguredMethod method = MethodRegistry::built_in().configure(entry.name);
  for (std::size_t i = 0; i < entry.parameters.size(); ++i) {
    const ParameterSpec& spec = entry.parameters[i];
    for (const ParameterValue& value : other_values(spec, method.configuration[i].second)) {
      ConfiguredMethod switched = method;
      set_parameter(switched.configuration, spec.name, value);
      if (!has_effect(spec, switched.configuration)) continue;
      requests.push_back(
          request_for(switched, entry.name + " with " + spec.name + " = " + parameter_text(value)));
    }
  }
}

std::vector<MethodRequest> requests_for(const std::vector<std::string>& names) {
  std::vector<MethodRequest> requests;
  for (const auto& entry : MethodRegistry::built_in().entries()) {
    if (!names.empty() && std::find(names.begin(), names.end(), entry->name) == names.end()) {
      continue;
    }
    for (const MethodVariant& variant : entry->variants) {
      const std::string name = entry->name + ":" + variant.name;
      requests.push_back(request_for(MethodRegistry::built_in().configure(name), name));
    }
    add_switched(*entry, requests);
  }
  return requests;
}

MethodAnswer answer_of(const Sequence& sequence, const MethodRequest& request, int threads) {
  MethodTask task;
  task.sequence = &sequence;
  task.request = &request;
  task.options.threads = threads;
  task.options.with_reasons = true;
  return run_method(task);
}

/// What differs between two answers; nothing if they are the same.
std::string difference(const MethodAnswer& one, const MethodAnswer& many) {
  if (one.status != many.status || one.reason != many.reason) return "another outcome";
  if (one.masks.size() != many.masks.size()) return "another number of masks";
  for (std::size_t scan = 0; scan < one.masks.size(); ++scan) {
    if (one.masks.get(scan) != many.masks.get(scan))
      return fmt::format("the mask of scan {}", scan);
  }
  if (one.reasons.codes != many.reasons.codes) return "the reasons";
  return "";
}

/// @return the number of thread counts that change the answer
int compare(const Sequence& sequence, const MethodRequest& request) {
  const MethodAnswer one = answer_of(sequence, request, 1);
  if (one.status != CellStatus::kOk) {
    std::cout << request.name << ": refused: " << one.reason << std::endl;
    return 0;
  }
  int different = 0;
  for (const int threads : kThreads) {
    const std::string found = difference(one, answer_of(sequence, request, threads));
    if (found.empty()) continue;
    std::cout << request.name << ": " << threads << " threads change " << found << std::endl;
    ++different;
  }
  if (different == 0) {
    std::cout << request.name << ": the same, " << grouped_text(one.masks.removed_count())
              << " points removed" << std::endl;
  }
  return different;
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.empty()) throw UsageError("raymoval_threads: give a sequence.");
  SequenceOptions options;
  if (arguments.size() > 1) options.frames = parse_frame_range(arguments[1]);
  const Sequence sequence = open_sequence(arguments[0], options);
  const auto first_name = arguments.begin() + std::min<std::ptrdiff_t>(2, std::ssize(arguments));
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 8);
  int different = 0;
  const std::vector<MethodRequest> requests = requests_for({first_name, arguments.end()});
  for (const MethodRequest& request : requests) different += compare(sequence, request);
  std::cout << requests.size() << " methods, variants and settings; " << different
            << " answers differ from that of one thread" << std::endl;
  return requests.empty() || different > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << error.what() << std::endl;
    return 2;
  }
}
