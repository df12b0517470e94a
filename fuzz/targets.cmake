# SPDX-License-Identifier: Apache-2.0
# One target for each thing that reads bytes, from files/<name>_fuzz.cpp or packets/<name>_fuzz.cpp: a libFuzzer
# program here, a replay of kept inputs in the tests. node_receive: what a node makes of its port; node_clock: what a
# clock makes of a node.
set(KINALIGN_FUZZ_FILES archive bids bids_check bvh c3d dataset denoise_model fuse_model layout live_stream manifest mcap mvnx npy ntu_skeleton opensim_sto
  parameters_json pose_model recording safetensors table take_hdf5 trc
  truth_json ui_prmd_kinect windows_file xdf xsens_text)
set(KINALIGN_FUZZ_PACKETS chrony_tracking clockless kinect_stream marks node_clock node_responder node_frame node_receive
  node_reply noitom_stream ntp_packet ntp_responder slimevr_responder slimevr_packet xsens_mvn)
set(KINALIGN_FUZZ_ROOMS kinalign_dataset_import kinalign_recording_live kinalign_models kinalign_models_fuse kinalign_models_pose kinalign_sources kinalign_formats_take kinalign_formats_xdf kinalign_protocols_marks
  kinalign_protocols_slimevr kinalign_capture_ntp kinalign_capture_recorder kinalign_node)
