// SPDX-License-Identifier: MIT
#include "datasets/inspection/inspect.h"

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "datasets/bag_scans/bag_source.h"
#include "datasets/bag_scans/topics.h"
#include "datasets/inspection/checks/checks.h"
#include "datasets/inspection/evidence/pair_fit.h"
#include "datasets/inspection/unopenable.h"

namespace raymoval {

namespace {

/// Fills in what the check says of all its findings.
Finding completed(Finding finding, const InspectionCheck& check,
                  const inspection::Samples& samples) {
  if (finding.check.empty()) finding.check = check.name;
  if (finding.expected.empty()) finding.expected = check.expected;
  if (finding.remedy.empty()) finding.remedy = check.remedy;
  finding.consequence = check.consequence;
  if (finding.where.empty()) finding.where = samples.pose_source() + ", " + samples.all_frames();
  return finding;
}

}  // namespace

const std::vector<InspectionCheck>& inspection_checks() {
  using namespace inspection;
  static const std::vector<Check> checks = [] {
    std::vector<Check> all;
    for (const auto& part :
         {recording_checks(), reach_checks(), point_checks(), pose_checks(), time_checks(),
          label_checks(), ego_checks(), sensor_model_checks(), skew_checks(), world_checks()}) {
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }();
  return checks;
}

InspectionReport inspect(const Sequence& sequence, const std::atomic<bool>* cancel) {
  inspection::Samples samples(sequence, cancel);
  inspection::settle_point_unit(samples);
  InspectionReport report;
  report.sequence = sequence.name;
  report.layout = sequence.layout;
  report.scans = samples.size();
  report.scans_read = samples.scans().size();
  for (const InspectionCheck& check : inspection_checks()) {
    if (cancel != nullptr && cancel->load()) throw Cancelled();
    for (Finding& finding : check.look(samples)) {
      report.findings.push_back(completed(std::move(finding), check, samples));
    }
  }
  report.notes = sequence.notes;  // The checks tell its damage.
  report.notes.insert(report.notes.end(), sequence.losses.begin(), sequence.losses.end());
  if (const auto* scans = dynamic_cast<const BagScanSource*>(&stored_source(sequence))) {
    report.notes.push_back(bag_name(scans->bag()) + ": " + topics_sentence(scans->bag()));
  }
  report.sensor = inspection::sensor_text(samples);
  report.measures = std::move(samples.measures);
  return report;
}

InspectionReport inspect_path(const std::string& path, const SequenceOptions& options,
                              const OpenContext& context) {
  InspectionReport report;
  report.sequence = std::filesystem::path(path).filename().string();
  report.findings = inspection::unopenable_findings(path, options);
  if (!report.findings.empty()) return report;
  return inspect(open_sequence(path, options, context), context.cancel);
}

}  // namespace raymoval
