# SPDX-License-Identifier: Apache-2.0
# The declared layouts: compiled into the program and installed as files to copy from.
set(layouts imu keraal_kinect keraal_vicon kinect kinect2_phone_skip kinect_laban kinect_multitrack
  lsl_kinect ui_prmd_vicon unsw_imu unsw_vicon)
list(TRANSFORM layouts REPLACE "(.+)" "${CMAKE_SOURCE_DIR}/layouts/\\1.toml" OUTPUT_VARIABLE layout_files)
list(JOIN layout_files "," layout_list)
set(builtin_layouts ${CMAKE_CURRENT_BINARY_DIR}/builtin_layouts.cpp)
add_custom_command(OUTPUT ${builtin_layouts}
  COMMAND ${CMAKE_COMMAND} -DOUT=${builtin_layouts} -DFILES=${layout_list} -P ${CMAKE_SOURCE_DIR}/cmake/embed_layouts.cmake
  DEPENDS ${layout_files} ${CMAKE_SOURCE_DIR}/cmake/embed_layouts.cmake VERBATIM)
install(FILES ${layout_files} DESTINATION ${CMAKE_INSTALL_DATADIR}/kinalign/layouts)
install(FILES ${CMAKE_SOURCE_DIR}/layouts/viewers/lichtblick.json
  DESTINATION ${CMAKE_INSTALL_DATADIR}/kinalign/viewers)
