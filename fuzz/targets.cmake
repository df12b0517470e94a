# SPDX-License-Identifier: Apache-2.0
# One target for each thing that reads bytes, from <name>_fuzz.cpp: a libFuzzer program here, a replay of kept inputs
# in the tests. node_receive: what a node makes of its port; node_clock: what a clock makes of a node.
set(KINALIGN_FUZZ_TARGETS bvh chrony_tracking clockless kinect_stream layout manifest marks mcap node_clock node_desk
  node_frame node_receive node_reply noitom_stream ntp_packet ntp_responder ntu_skeleton opensim_sto parameters_json recording
  slimevr_desk slimevr_packet table take_hdf5 trc truth_json ui_prmd_kinect xdf xsens_mvn xsens_text)
