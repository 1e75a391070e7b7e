// SPDX-License-Identifier: MIT
#include <deque>
#include <memory>

#include "benchmark/cli/command.h"
#include "benchmark/submission/leaderboard.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"
#include "core/files/files.h"
#include "core/terminal_colour.h"
#include "datasets/open_sequence.h"

namespace raymoval {
namespace {

struct VerifyFlags {
  std::vector<std::string> submissions;
  std::string masks, data, table;
  SequenceFlags reading;
  WorkFlags work;
};

/// Where the sequence of a cell is: a scene of this name, or what --data says.
std::string place_of(const Cell& cell, const std::string& data) {
  if (data.empty()) {
    if (is_scene(cell.sequence)) return cell.sequence;
    throw DataError("the data of sequence '" + cell.sequence +
                    "' is not at hand. Say where it is with --data PATH: its folder, a folder that "
                    "has it by its name, or the scene.");
  }
  check_not_both(data);
  if (is_scene(data)) return data;
  const std::filesystem::path below = std::filesystem::path(data) / cell.sequence;
  return has_folder(below) ? below.string() : data;
}

/// Sequences that were opened, each with the first cell that asked for it.
struct Opened {
  Cell cell;
  std::string place;
  std::unique_ptr<ScoredSequence> scored;
};

class Verifier {
 public:
  explicit Verifier(const VerifyFlags& flags)
      : flags_(flags), threads_(flags.work.thread_count()), progress_(flags.work.style()) {}

  Verification verify(const SubmittedCell& submitted) {
    std::string problem;
    try {
      return verify_cell(submitted, scored_for(submitted.cell), &interrupt_flag());
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      if (error.exit_code() == ExitCode::kInternal) throw;
      problem = error.what();
    }
    return {submitted, {}, once(problem)};
  }
  void end() { progress_.end(); }

 private:
  /// All cells of a run have the problem of a --data that is not there. It is told once.
  std::string once(const std::string& problem) {
    if (problem == told_) return "for the reason given above";
    told_ = problem;
    return problem;
  }

  ScoredSequence& scored_for(const Cell& cell) {
    const std::string place = place_of(cell, flags_.data);
    for (Opened& opened : opened_) {
      if (opened.place == place && same_sequence(opened.cell, cell)) return *opened.scored;
    }
    const std::vector<ProtocolRequest> protocols = requested_protocols_of(cell);
    Sequence sequence = open_sequence(place, reading_of(cell, flags_.reading.options()),
                                      {threads_, &progress_, &interrupt_flag()});
    tell_opening(sequence, progress_);
    opened_.push_back(
        {cell, place,
         std::make_unique<ScoredSequence>(std::move(sequence), protocols, threads_, &progress_)});
    return *opened_.back().scored;
  }

  const VerifyFlags& flags_;
  int threads_;
  Progress progress_;
  std::deque<Opened> opened_;
  std::string told_;  ///< The last problem.
};

std::vector<Verification> verify_all(const VerifyFlags& flags) {
  std::vector<SubmittedCell> cells;
  const bool alone = flags.submissions.size() == 1;
  for (const std::string& submission : flags.submissions) {
    for (SubmittedCell& cell : read_submission(submission, flags.masks, alone)) {
      cells.push_back(std::move(cell));
    }
  }
  Verifier verifier(flags);
  std::vector<Verification> verified;
  for (const SubmittedCell& cell : cells) verified.push_back(verifier.verify(cell));
  verifier.end();
  return verified;
}

std::string table_text(const std::vector<Verification>& verified) {
  std::string text;
  for (const TextTable& table : leaderboard(verified)) {
    text += (text.empty() ? "" : "\n") + to_markdown(table);
  }
  return text;
}

std::string coloured_answers(const std::string& text) {
  return coloured_phrases(text,
                          {{": holds\n", TerminalColour::kGood},
                           {": does not hold\n", TerminalColour::kBad},
                           {": cannot be checked\n", TerminalColour::kNotice}},
                          stdout);
}

ExitCode verify(const VerifyFlags& flags) {
  if (flags.submissions.empty())
    throw UsageError("verify what? Expected `raymoval verify SUBMISSION [--masks DIR]`.");
  if (!flags.table.empty()) check_folder_of(flags.table);
  const std::vector<Verification> verified = verify_all(flags);
  std::size_t others = 0, unchecked = 0;
  for (const Verification& one : verified) {
    print(coloured_answers(verification_text(one)));
    others += one.verdict() == SubmissionVerdict::kDiffers ? 1 : 0;
    unchecked += one.verdict() == SubmissionVerdict::kUnchecked ? 1 : 0;
  }
  if (!flags.table.empty()) write_atomically(output_target(flags.table), table_text(verified));
  if (others > 0) throw Error("not all that was submitted holds, see above.", ExitCode::kWorse);
  if (unchecked > 0) throw DataError("not all that was submitted can be checked, see above.");
  return ExitCode::kDone;
}

}  // namespace

Command add_verify_command(CommandParser& program) {
  auto flags = std::make_shared<VerifyFlags>();
  CommandOptions options = program.add_command(
      "verify", "Scores the masks of a submission again, and says whether its results hold");
  options.add("submission", "SUBMISSION", flags->submissions,
              "A cell.json, a folder with such files, or a run folder; several for one table");
  options.add(
      "--masks", "DIR", flags->masks,
      "Folder with a label file for each scan, or with such folders by name of submission and "
      "sequence (default: removals beside the cell.json, as `run --keep-removals` leaves it)");
  options.add("--data", "PATH", flags->data,
              "The sequence, a folder that has sequences by name, or a scene (default: the scene "
              "of the submission's name)");
  options.add("--table", "FILE", flags->table,
              "Write a table of all that holds as Markdown, with ranks by paired intervals");
  flags->reading.add_to(options);
  flags->work.add_to(options);
  options.set_footer(
      "Compared are: the key with method, version, parameters, data and protocols; the data's\n"
      "fingerprint; the hash of the masks; every count, rate, interval and share of points that "
      "the\n"
      "masks score; none may be missing or added.\n"
      "Frames, range and own vehicle are read as the submission says. Whether masks come from the\n"
      "method they are said to come from is seen by running it only.\n"
      "Exit codes: 0 holds, 1 does not hold, 2 cannot be checked (data or masks are absent, a "
      "file\n"
      "is damaged, or it was scored by another version).\nExamples:\n"
      "  raymoval run --sequence street --method raymoval:online --keep-removals --out out/street\n"
      "  raymoval verify out/street\n"
      "  raymoval verify results/submissions/voxel_counts --masks out/masks\n"
      "  raymoval verify theirs/cell.json --masks theirs/labels --data data/05\n"
      "  raymoval verify out/street theirs/cell.json --table leaderboard.md");
  return {options.name(), [flags] { return verify(*flags); }};
}

}  // namespace raymoval
