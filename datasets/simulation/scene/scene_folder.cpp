// SPDX-License-Identifier: MIT
#include "datasets/simulation/scene/scene_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/files/descriptor_io.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"
#include "core/files/files.h"
#include "core/parallel.h"
#include "core/text.h"

namespace raymoval::simulated {
namespace {

namespace fs = std::filesystem;

constexpr int kManifestVersion = 1;

[[noreturn]] void throw_unwritable(const fs::path& path) {
  throw DataError(path.string() + ": cannot be written (" + std::generic_category().message(errno) +
                  "); the disk may be full or the folder read-only.");
}

/// A file that is new and on the disk when this returns. It needs no temporary name: the folder as
/// a whole is what appears atomically.
void write_synced(const fs::path& path, const void* data, std::size_t size) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!file.valid()) throw_unwritable(path);
  const bool written = write_at(file.get(), {static_cast<const char*>(data), size}, 0);
  if (!written || ::fsync(file.get()) != 0) throw_unwritable(path);
}

std::string hash_of(const void* data, std::size_t size) {
  return content_hash({static_cast<const char*>(data), size});
}

struct ListedFile {
  std::string name;
  std::uintmax_t bytes = 0;
  std::string hash;
};

/// @throws nlohmann::json::exception if it has another form
std::vector<ListedFile> listed_files(const nlohmann::json& manifest) {
  std::vector<ListedFile> files;
  for (const auto& [name, file] : manifest.at("files").items()) {
    files.push_back(
        {name, file.at("bytes").get<std::uintmax_t>(), file.at("xxh3_128").get<std::string>()});
  }
  return files;
}

std::string size_problem(const fs::path& folder, const std::vector<ListedFile>& files) {
  std::size_t scans = 0;
  for (const ListedFile& file : files) {
    if (!has_file(folder / file.name)) return file.name + " is missing";
    const std::uintmax_t bytes = plain_file_size(folder / file.name);
    if (bytes != file.bytes) {
      return file.name + " has " + grouped_text(bytes) + " bytes, written were " +
             grouped_text(file.bytes);
    }
    scans += file.name.starts_with("velodyne/") ? 1 : 0;
  }
  if (!has_folder(folder / "velodyne")) return "velodyne/ is missing";
  const std::vector<fs::path> there = entries_of(folder / "velodyne");
  const auto found = static_cast<std::size_t>(std::count_if(
      there.begin(), there.end(), [](const fs::path& path) { return path.extension() == ".bin"; }));
  if (found != scans) {
    return "velodyne/ has " + counted_text(found, "scan") + ", written were " +
           std::to_string(scans);
  }
  return "";
}

std::string content_problem(const fs::path& folder, const std::vector<ListedFile>& files,
                            int threads) {
  std::vector<char> differs(files.size(), 0);
  parallel_for(threads, files.size(), 1, [&](std::size_t i) {
    const std::vector<std::byte> bytes = read_bytes(folder / files[i].name);
    differs[i] = hash_of(bytes.data(), bytes.size()) != files[i].hash ? 1 : 0;
  });
  const auto changed = std::find(differs.begin(), differs.end(), 1);
  if (changed == differs.end()) return "";
  return files[static_cast<std::size_t>(changed - differs.begin())].name +
         " has another content than was written";
}

}  // namespace

SceneFolder::SceneFolder(fs::path folder) : folder_(std::move(folder)) {
  for (const char* name : {"velodyne", "labels"}) {
    std::error_code error;
    fs::create_directory(folder_ / name, error);
    if (error) {
      throw DataError((folder_ / name).string() + ": cannot be made (" + error.message() +
                      "). Choose a folder you may write to.");
    }
  }
}

void SceneFolder::write(const std::string& name, const void* data, std::size_t size) {
  write_synced(folder_ / name, data, size);
  Entry entry{size, hash_of(data, size)};
  const std::lock_guard lock(mutex_);
  entries_[name] = std::move(entry);
}

void SceneFolder::write(const std::string& name, const std::string& text) {
  write(name, text.data(), text.size());
}

void SceneFolder::finish(const std::string& identity) {
  nlohmann::ordered_json json;
  json["schema_version"] = kManifestVersion;
  json["identity"] = identity;
  json["files"] = nlohmann::ordered_json::object();
  for (const auto& [name, entry] : entries_) {
    json["files"][name] = {{"bytes", entry.bytes}, {"xxh3_128", entry.hash}};
  }
  for (const char* below : {"velodyne", "labels"}) sync_folder(folder_ / below);
  const std::string text = json.dump(1) + "\n";
  write_synced(folder_ / kManifestName, text.data(), text.size());
  sync_folder(folder_);
}

std::string scene_folder_problem(const fs::path& folder, const std::string& identity,
                                 bool with_content, int threads) {
  try {
    const fs::path list = folder / kManifestName;
    if (!has_file(list)) return std::string(kManifestName) + " is missing";
    const nlohmann::json manifest = read_json(list);
    if (manifest.at("identity") != identity) return "it is of another scene";
    const std::vector<ListedFile> files = listed_files(manifest);
    const std::string problem = size_problem(folder, files);
    return problem.empty() && with_content ? content_problem(folder, files, threads) : problem;
  } catch (const nlohmann::json::exception&) {
    return std::string(kManifestName) + " is damaged";
  } catch (const UnreadableError&) {
    throw;  // Nobody can say that something is wrong with it.
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace raymoval::simulated
