// SPDX-License-Identifier: MIT
#pragma once

namespace raymoval::kernels_bench {

/// First-hit images by all designs, on each workload.
void register_image_kernels();
/// Insert, erase, look-up, upkeep and image against the size of the map.
void register_map_kernels();
/// Other steps of the scan loop.
void register_scan_kernels();
/// The whole scan loop.
void register_method_kernels();

}  // namespace raymoval::kernels_bench
