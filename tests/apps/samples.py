# SPDX-License-Identifier: Apache-2.0
"""Small files of every format that the program reads, made by hand."""
import json

JOINTS = ("SpineBase SpineMid Neck Head ShoulderLeft ElbowLeft WristLeft HandLeft ShoulderRight "
          "ElbowRight WristRight HandRight HipLeft KneeLeft AnkleLeft FootLeft HipRight KneeRight "
          "AnkleRight FootRight SpineShoulder HandTipLeft ThumbLeft HandTipRight ThumbRight").split()
STEP = 33_333_333


def bvh(frames=4, step="0.0333333"):
    rows = "".join(f"0.0 90.0 {i} {i}.5 0.25 -3e-1 {10 * i} 5 0\n" for i in range(frames))
    return ("HIERARCHY\nROOT Hips\n{\n  OFFSET 0 0 0\n"
            "  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
            "  JOINT Spine\n  {\n    OFFSET 0 20.5 0\n"
            "    CHANNELS 3 Zrotation Xrotation Yrotation\n"
            "    End Site\n    {\n      OFFSET 0 10 0\n    }\n  }\n}\n"
            f"MOTION\nFrames: {frames}\nFrame Time: {step}\n{rows}")


def kinect(rows=4, start=0):
    head = "time_ns" + "".join(f",{j}_x,{j}_y,{j}_z,{j}_state" for j in JOINTS)
    body = "".join(f"{start + i * STEP}" + "".join(f",{0.1 * j - 1:.3f},1.{j},2.{i},2" for j in range(25))
                   + "\n" for i in range(rows))
    return f"{head}\n{body}"


def imu(rows=4, start=0):
    return "time_ns,qw,qx,qy,qz,ax,ay,az,gx,gy,gz\n" + "".join(
        f"{start + i * STEP},1,0,0,0,0.1,9.8,0.{i},0,0.5,0\n" for i in range(rows))


def keraal():
    return "".join(" ".join(f"{0.1 * j} 1.{i} 2 1 0 0 0" for j in range(25)) + "\n" for i in range(3))


def multitrack():
    names = sorted(JOINTS)
    head = ("Study, KinectConfig, Scenario, Tracker_Time, Person#, Skeleton#, Skeleton_Time, "
            "Skeleton_Init_Angle, Skeleton_Init_Dist, Kinect#, Kinect_Tilt_Angle, Kinect_Height")
    head += "".join(f", {j}_X, {j}_Y, {j}_Z" for j in names)
    return head + "\n" + "".join(
        f"10, 0, 1, {63562205247984 + 33 * i}, 0, 0, 636645975903, -0.1, 2.4, 10.0.0.1, 0, 100"
        + ", 0.25, -0.5, 2.5" * 25 + "\n" for i in range(3))


def ntu():
    body = "72057594037931101 0 1 1 1 0 0 0.1 -0.2 2\n25\n" + "".join(
        f"{j} 1 2 nan 200.5 nan 500 0 0 0 0 2\n" for j in range(25))
    return "3\n0\n" + 2 * ("1\n" + body)


def xsens():
    return ("// Update Rate: 100.0Hz\nPacketCounter\tSampleTimeFine\tAcc_X\tAcc_Y\tAcc_Z\tGyr_X\tGyr_Y"
            "\tGyr_Z\tQuat_q0\tQuat_q1\tQuat_q2\tQuat_q3\n65534\t\t1\t2\t3\t4\t5\t6\t1\t0\t0\t0\n"
            "65535\t\t1\t2\t3\t4\t5\t6\t1\t0\t0\t0\n2\t\t\t2\t3\t4\t5\t6\t1\t0\t0\t0\n")


def sto():
    return ("\nDataRate=100.000000\nDataType=Quaternion\nversion=3\nOpenSimVersion=4.1\n endheader \n"
            "time\ttorso_imu\tpelvis_imu\n678\t1,0,0,0\t0.5,0.5,0.5,0.5\n678.01\tnan\t1,0,0,0\n")


def trc():
    return ("PathFileType\t4\t(X/Y/Z)\twalk.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\t"
            "OrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n100\t100\t2\t2\tmm\t100\t1\t2\n"
            "Frame#\tTime\tHEAD\t\t\tR.TOE\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n"
            "1\t0.01\t1000\t2000\t-3E2\t\t\t\t\n2\t0.02\tNaN\tnan\tNAN\t1\t2\t3\n")


def layout():
    return ('name = "mine"\nkind = "points"\ndelimiter = "comma"\nheader = true\nrate_hz = 30\n'
            '[time]\ncolumn = "t"\nunit = "ms"\n[joints]\nnames = ["A", "B"]\n'
            'fields = { x = "{joint}_x", y = "{joint}_y", z = "{joint}_z" }\n')


def laid_out():
    return "t,A_x,A_y,A_z,B_x,B_y,B_z\n0,1,2,3,4,5,6\n33,1,2,3,4,5,6.5\n66,,,,4,5,6\n"


def manifest(**files):
    names = {"mocap": "mocap.bvh", "kinect": "kinect.csv", "imu": "imu.csv", **files}
    text = 'subject = "S01"\n[align]\nreference = "mocap"\n'
    for stream, name in names.items():
        text += f"[stream.{stream}]\nfile = {json.dumps(name)}\n"
        text += "start_ns = 0\n" if stream == "mocap" else ""
    return text + '[space.kinect]\nmethod = "paper"\n'


STREAMS = {"walk.bvh": bvh, "kinect.csv": kinect, "imu.csv": imu, "keraal.txt": keraal,
           "multitrack.csv": multitrack, "ntu.skeleton": ntu, "MT_01_00B421E6.txt": xsens,
           "imus.sto": sto, "walk.trc": trc}


def recording(folder):
    """The three streams, their manifest and a layout; the manifest's path."""
    folder.mkdir(exist_ok=True)
    for name, text in (("mocap.bvh", bvh()), ("kinect.csv", kinect()), ("imu.csv", imu()),
                       ("recording.toml", manifest())):
        (folder / name).write_text(text)
    return folder / "recording.toml"
