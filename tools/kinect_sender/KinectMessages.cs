// SPDX-License-Identifier: Apache-2.0
// The messages that are sent to kinalign, and their bytes: docs/formats/kinect_stream.md. Knows neither
// the SDK nor sockets. C# 5, so that the compiler of .NET Framework 4 builds it.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Text;
using System.Text.RegularExpressions;

namespace Kinalign
{
    /// The numbers of the layout; tests/protocols/kinect/sender_test.cpp holds them against the C++ side.
    public static class Layout
    {
        public const uint Magic = 0x4b4e414b;  // the bytes "KANK"
        public const byte Version = 1;
        public const byte HelloType = 1, FrameType = 2, PingType = 3, PongType = 4;
        public const byte UtcFlag = 1, FloorFlag = 2, OrientationsFlag = 4, HandsFlag = 8, MorePartsFlag = 16;
        public const byte EchoFlag = 1;
        public const byte KinectV2 = 1;
        public const int Joints = 25;
        public const int HeadSize = 24, CrcSize = 4, FrameFieldsSize = 48, PongSize = 36;
        public const int BodySize = 12 + Joints + 12 * Joints, OrientationsSize = 16 * Joints;
        public const int MostDatagram = 1452, MostBodies = 6, MostText = 64;
        public const int LeastPingLine = 160;
        public const string Schema = "kinalign.kinect/1";
    }

    public sealed class Body
    {
        public ulong Id;
        public byte ClippedEdges, HandLeft, HandRight, HandConfidence;
        public readonly byte[] States = new byte[Layout.Joints];
        public readonly float[] Positions = new float[3 * Layout.Joints];     // x, y, z
        public readonly float[] Orientations = new float[4 * Layout.Joints];  // w, x, y, z
    }

    public sealed class Frame
    {
        public uint Sequence;
        public long DeviceTicks, TakenTicks, UtcMicroseconds;
        public float[] Floor;  // x, y, z, w; null: none was found
        public bool Orientations, Hands;
        public readonly List<Body> Bodies = new List<Body>();
    }

    /// The newest pong that arrived.
    public sealed class Echo
    {
        public uint PongSequence, Nonce;
        public long ReceivedTicks;
    }

    public static class Crc32
    {
        private static readonly uint[] Table = MakeTable();

        private static uint[] MakeTable()
        {
            var table = new uint[256];
            for (uint i = 0; i < 256; ++i)
            {
                uint value = i;
                for (int bit = 0; bit < 8; ++bit) value = (value & 1) != 0 ? (value >> 1) ^ 0xedb88320 : value >> 1;
                table[i] = value;
            }
            return table;
        }

        public static uint Of(byte[] bytes, int count)
        {
            uint crc = 0xffffffff;
            for (int i = 0; i < count; ++i) crc = (crc >> 8) ^ Table[(crc ^ bytes[i]) & 0xff];
            return crc ^ 0xffffffff;
        }
    }

    /// One sensor in one run of this program.
    public sealed class Messages
    {
        private readonly uint sensor, session;

        public Messages(uint sensor, uint session)
        {
            this.sensor = sensor;
            this.session = session;
        }

        // ---- binary; a BinaryWriter's numbers are little-endian on every machine

        public byte[] Hello(uint sequence, string serial, string sdk)
        {
            return Sealed(Layout.HelloType, sequence, 0, Layout.KinectV2, 0, 0, delegate(BinaryWriter writer)
            {
                PutText(writer, serial);
                PutText(writer, sdk);
            });
        }

        /// How many bodies of this frame fit one datagram.
        public static int BodiesInPart(Frame frame)
        {
            int body = Layout.BodySize + (frame.Orientations ? Layout.OrientationsSize : 0);
            return (Layout.MostDatagram - Layout.HeadSize - Layout.FrameFieldsSize - Layout.CrcSize) / body;
        }

        /// Bodies `first` to `first + count`, as this part.
        public byte[] FramePart(Frame frame, int first, int count, byte part, bool more, long sent)
        {
            byte flags = Layout.UtcFlag;
            if (frame.Floor != null) flags |= Layout.FloorFlag;
            if (frame.Orientations && count > 0) flags |= Layout.OrientationsFlag;
            if (frame.Hands && count > 0) flags |= Layout.HandsFlag;
            if (more) flags |= Layout.MorePartsFlag;
            return Sealed(Layout.FrameType, frame.Sequence, flags, Layout.KinectV2, (byte)count, part,
                          delegate(BinaryWriter writer)
            {
                writer.Write(frame.DeviceTicks);
                writer.Write(frame.TakenTicks);
                writer.Write(sent);
                writer.Write(frame.UtcMicroseconds);
                for (int i = 0; i < 4; ++i) writer.Write(frame.Floor == null ? 0.0f : frame.Floor[i]);
                for (int i = first; i < first + count; ++i) PutBody(writer, frame, frame.Bodies[i]);
            });
        }

        public byte[] Ping(uint sequence, long sent, Echo echo)
        {
            byte flags = echo == null ? (byte)0 : Layout.EchoFlag;
            return Sealed(Layout.PingType, sequence, flags, 0, 0, 0, delegate(BinaryWriter writer)
            {
                writer.Write(sent);
                writer.Write(echo == null ? 0u : echo.PongSequence);
                writer.Write(echo == null ? 0u : echo.Nonce);
                writer.Write(echo == null ? 0L : echo.ReceivedTicks);
            });
        }

        /// Null: no pong of this session.
        public Echo ReadPong(byte[] bytes, int length, long received)
        {
            if (length != Layout.PongSize) return null;
            var reader = new BinaryReader(new MemoryStream(bytes, 0, length));
            if (reader.ReadUInt32() != Layout.Magic || reader.ReadByte() != Layout.Version) return null;
            if (reader.ReadByte() != Layout.PongType || reader.ReadUInt16() != Layout.PongSize) return null;
            if (reader.ReadUInt32() != sensor || reader.ReadUInt32() != session) return null;
            reader.ReadUInt64();  // sequence of the ping, flags and what is 0
            var echo = new Echo();
            echo.PongSequence = reader.ReadUInt32();
            echo.Nonce = reader.ReadUInt32();
            echo.ReceivedTicks = received;
            return reader.ReadUInt32() == Crc32.Of(bytes, length - Layout.CrcSize) ? echo : null;
        }

        private byte[] Sealed(byte type, uint sequence, byte flags, byte jointSet, byte bodies, byte part,
                              Action<BinaryWriter> putFields)
        {
            var stream = new MemoryStream();
            var writer = new BinaryWriter(stream);
            writer.Write(Layout.Magic);
            writer.Write(Layout.Version);
            writer.Write(type);
            writer.Write((ushort)0);  // until it is known
            writer.Write(sensor);
            writer.Write(session);
            writer.Write(sequence);
            writer.Write(flags);
            writer.Write(jointSet);
            writer.Write(bodies);
            writer.Write(part);
            putFields(writer);
            long end = stream.Position;
            stream.Position = 6;
            writer.Write((ushort)(end + Layout.CrcSize));
            stream.Position = end;
            writer.Write(Crc32.Of(stream.GetBuffer(), (int)end));
            return stream.ToArray();
        }

        private static void PutText(BinaryWriter writer, string text)
        {
            writer.Write((byte)text.Length);
            writer.Write(Encoding.ASCII.GetBytes(text));
        }

        private static void PutBody(BinaryWriter writer, Frame frame, Body body)
        {
            writer.Write(body.Id);
            writer.Write(body.ClippedEdges);
            writer.Write(frame.Hands ? body.HandLeft : (byte)0);
            writer.Write(frame.Hands ? body.HandRight : (byte)0);
            writer.Write(frame.Hands ? body.HandConfidence : (byte)0);
            writer.Write(body.States);
            foreach (float x in body.Positions) writer.Write(x);
            if (!frame.Orientations) return;
            foreach (float x in body.Orientations) writer.Write(x);
        }

        // ---- lines

        public string HelloLine(uint sequence, string serial, string sdk)
        {
            return Begun("hello", sequence) + ",\"joint_set\":\"kinect_v2\",\"serial\":" + Quoted(serial) +
                   ",\"sdk\":" + Quoted(sdk) + "}\n";
        }

        public string FrameLine(Frame frame, long sent)
        {
            var line = new StringBuilder(Begun("frame", frame.Sequence));
            line.Append(",\"joint_set\":\"kinect_v2\",\"device_ticks\":").Append(Number(frame.DeviceTicks));
            line.Append(",\"taken_ticks\":").Append(Number(frame.TakenTicks));
            line.Append(",\"sent_ticks\":").Append(Number(sent));
            line.Append(",\"utc_us\":").Append(Number(frame.UtcMicroseconds));
            if (frame.Floor != null) line.Append(",\"floor\":").Append(List(frame.Floor, 0, 4));
            line.Append(",\"bodies\":[");
            for (int i = 0; i < frame.Bodies.Count; ++i)
            {
                if (i > 0) line.Append(',');
                AppendBody(line, frame, frame.Bodies[i]);
            }
            return line.Append("]}\n").ToString();
        }

        public string PingLine(uint sequence, long sent, Echo echo)
        {
            string line = Begun("ping", sequence) + ",\"sent_ticks\":" + Number(sent);
            if (echo != null)
            {
                line += ",\"echo\":{\"pong_sequence\":" + Number(echo.PongSequence) + ",\"nonce\":" +
                        Number(echo.Nonce) + ",\"received_ticks\":" + Number(echo.ReceivedTicks) + "}";
            }
            return (line + "}").PadRight(Layout.LeastPingLine - 1) + "\n";
        }

        /// Null: no pong of this session.
        public Echo ReadPongLine(string line, long received)
        {
            uint itsSession, sequence, nonce;
            bool pong = line.Contains("\"pong\"") && Field(line, "session", out itsSession) &&
                        itsSession == session;
            if (!pong || !Field(line, "pong_sequence", out sequence) || !Field(line, "nonce", out nonce)) return null;
            var echo = new Echo();
            echo.PongSequence = sequence;
            echo.Nonce = nonce;
            echo.ReceivedTicks = received;
            return echo;
        }

        private static bool Field(string line, string key, out uint value)
        {
            Match match = Regex.Match(line, "\"" + key + "\"\\s*:\\s*([0-9]{1,10})");
            value = 0;
            return match.Success && uint.TryParse(match.Groups[1].Value, NumberStyles.None,
                                                  CultureInfo.InvariantCulture, out value);
        }

        private string Begun(string type, uint sequence)
        {
            return "{\"schema\":\"" + Layout.Schema + "\",\"type\":\"" + type + "\",\"sensor\":" + Number(sensor) +
                   ",\"session\":" + Number(session) + ",\"sequence\":" + Number(sequence);
        }

        private static void AppendBody(StringBuilder line, Frame frame, Body body)
        {
            line.Append("{\"id\":\"").Append(body.Id.ToString(CultureInfo.InvariantCulture));
            line.Append("\",\"clipped_edges\":").Append(Number(body.ClippedEdges));
            if (frame.Hands)
            {
                line.Append(",\"hands\":[").Append(Number(body.HandLeft)).Append(',').Append(Number(body.HandRight));
                line.Append(',').Append(Number(body.HandConfidence)).Append(']');
            }
            line.Append(",\"states\":[");
            for (int i = 0; i < Layout.Joints; ++i) line.Append(i > 0 ? "," : "").Append(Number(body.States[i]));
            line.Append("],\"positions\":").Append(Rows(body.Positions, 3));
            if (frame.Orientations) line.Append(",\"orientations\":").Append(Rows(body.Orientations, 4));
            line.Append('}');
        }

        private static string Rows(float[] values, int width)
        {
            var rows = new StringBuilder("[");
            for (int at = 0; at < values.Length; at += width)
            {
                rows.Append(at > 0 ? "," : "").Append(List(values, at, width));
            }
            return rows.Append(']').ToString();
        }

        private static string List(float[] values, int first, int count)
        {
            var list = new StringBuilder("[");
            for (int i = first; i < first + count; ++i) list.Append(i > first ? "," : "").Append(Number(values[i]));
            return list.Append(']').ToString();
        }

        /// Nine digits give every float again; "R" of .NET Framework does not always.
        private static string Number(float value)
        {
            if (float.IsNaN(value) || float.IsInfinity(value)) return "null";
            return value.ToString("G9", CultureInfo.InvariantCulture);
        }

        private static string Number(long value)
        {
            return value.ToString(CultureInfo.InvariantCulture);
        }

        private static string Quoted(string text)
        {
            return "\"" + text.Replace("\\", "\\\\").Replace("\"", "\\\"") + "\"";
        }
    }
}
