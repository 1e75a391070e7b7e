# The headers that are installed, and that Doxygen reads: what a method in C++, or a program that
# reads data and scores answers, needs. tests/consumer/installed_test.sh compiles each of them alone.
# None of them includes CLI11, PCL, Highway or the whole of nlohmann/json.
set(raymoval_public_headers
  benchmark/harness.h
  core/error.h
  core/parallel.h
  core/parameters.h
  core/progress.h
  core/scan/label_rule.h
  core/scan/mask_store.h
  core/scan/range_limits.h
  core/scan/scan.h
  core/scan/scan_source.h
  core/scan/sensor_model.h
  core/scan/voxel_key.h
  core/stage_timer.h
  datasets/ego/ego_region.h
  datasets/sequence.h
  datasets/sequence_record.h
  datasets/world_axes/up_direction.h
  eval/bootstrap.h
  eval/protocol.h
  eval/protocol_registry.h
  eval/rate.h
  methods/common/scan_passes.h
  methods/method_entry.h
  methods/registry.h
  methods/remover.h)
