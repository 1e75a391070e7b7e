// SPDX-License-Identifier: MIT
#include "datasets/clouds/record_file.h"

#include <utility>

#include "core/error.h"
#include "core/files/file_writer.h"
#include "core/text.h"
#include "datasets/clouds/format/cloud_header.h"
#include "datasets/clouds/format/deflate.h"
#include "datasets/clouds/formats.h"

namespace raymoval {

std::vector<std::string> what_is_lost(const std::filesystem::path& path,
                                      const RecordLayout& layout) {
  return format_read(path).lost(layout);
}

bool holds_reference_system(const std::filesystem::path& path) {
  return format_written(path).holds_reference_system;
}

std::optional<ShownIntensity> shown_intensity(const std::filesystem::path& path,
                                              const RecordLayout& layout) {
  const CloudFormat& format = format_written(path);
  return format.shown_intensity == nullptr ? std::nullopt : format.shown_intensity(layout);
}

namespace {

std::unique_ptr<RecordEncoder> encoder_for(const std::filesystem::path& path,
                                           const RecordWriting& writing) {
  const CloudFormat& format = format_written(path);
  if (writing.crs && !format.holds_reference_system) {
    throw UsageError(path.string() + ": '" + format.extension +
                     "' holds no coordinate reference system; only .las does.");
  }
  return format.encoder(path, writing);
}

}  // namespace

class PointRecordWriter::Format {
 public:
  Format(const std::filesystem::path& path, const RecordWriting& writing)
      : encoder_(encoder_for(path, writing)), file_(path) {}

  void start(const RecordLayout& layout) {
    (void)position_fields(layout, file_.path().string());
    layout_ = layout;
  }

  void add(const PointRecords& rows) {
    check(rows);
    points_ += rows.size();
    if (points_ > kMostCloudPoints) {
      throw DataError(file_.path().string() + ": more than " + grouped_text(kMostCloudPoints) +
                      " points, which no reader takes. Nothing was changed; choose fewer frames or "
                      "a voxel size.");
    }
    begin(rows);
    file_.append(encoder_->rows(rows));
  }

  void finish() {
    PointRecords none;
    none.layout = layout_;
    begin(none);
    file_.append(encoder_->rest());
    file_.overwrite(0, encoder_->head(points_));
    file_.sync();
  }

  FileWriter& file() { return file_; }

 private:
  void check(const PointRecords& rows) const {
    if (rows.layout.fields != layout_.fields || rows.layout.row_bytes != layout_.row_bytes) {
      throw InternalError("points of another layout are written to " + file_.path().string());
    }
  }

  /// What stands in the head may depend on the first points.
  void begin(const PointRecords& first) {
    if (std::exchange(begun_, true)) return;
    encoder_->start(first);
    file_.append(encoder_->head(0));
  }

  std::unique_ptr<RecordEncoder> encoder_;
  FileWriter file_;
  RecordLayout layout_;
  std::uint64_t points_ = 0;
  bool begun_ = false;
};

std::string whole_file(const std::filesystem::path& path, const PointRecords& records) {
  const CloudFormat& format = format_read(path);
  (void)position_fields(records.layout, path.string());
  RecordWriting writing;
  writing.form = records.form;
  const auto encoder = format.encoder(path, writing);
  encoder->start(records);
  std::string body = encoder->rows(records);
  body += encoder->rest();
  std::string content = encoder->head(records.size()) + body;
  if (format.wrap != nullptr) content = format.wrap(content, records.form);
  return is_packed(path) ? pack_gzip(content) : content;
}

PointRecordWriter::PointRecordWriter(const std::filesystem::path& path,
                                     const RecordWriting& writing)
    : format_(std::make_unique<Format>(path, writing)) {}
PointRecordWriter::~PointRecordWriter() = default;

void PointRecordWriter::start(const RecordLayout& layout) {
  format_->start(layout);
}
void PointRecordWriter::add(const PointRecords& rows) {
  format_->add(rows);
}
void PointRecordWriter::finish() {
  format_->finish();
}
void PointRecordWriter::commit() {
  format_->file().commit();
}
void PointRecordWriter::commit_with(Replacements& together) {
  format_->file().commit_with(together);
}
const std::filesystem::path& PointRecordWriter::path() const {
  return format_->file().path();
}

}  // namespace raymoval
