// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The files of the page, from view/page.
namespace orrery::view {

extern const char* const kPageHtml;
extern const char* const kPageStyle;
extern const char* const kPageScript;    ///< view.js
extern const char* const kCameraScript;  ///< camera.js

}  // namespace orrery::view
