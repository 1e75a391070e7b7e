// SPDX-License-Identifier: MIT
#pragma once

namespace raymoval::kernels_bench {

/// First-hit images by all designs, on each workload.
void register_image_kernels();
/// Insert, erase, look-up, upkeep and image against the size of the map.
void register_map_kernels();
/// The other steps of the scan loop, and the whole of it.
void register_scan_kernels();

}  // namespace raymoval::kernels_bench
