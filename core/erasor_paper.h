// SPDX-License-Identifier: MIT
#pragma once

namespace raymoval {

/// BibTeX of the paper that both a method and a protocol come from.
inline constexpr const char* kErasorBibtex = R"(@article{lim2021erasor,
  author = {Lim, Hyungtae and Hwang, Sungwon and Myung, Hyun},
  title = {{ERASOR}: Egocentric Ratio of Pseudo Occupancy-Based Dynamic Object Removal for Static
    3D Point Cloud Map Building},
  journal = {IEEE Robotics and Automation Letters},
  year = {2021},
  volume = {6},
  number = {2},
  pages = {2272--2279},
  doi = {10.1109/LRA.2021.3061363}
}
)";

}  // namespace raymoval
