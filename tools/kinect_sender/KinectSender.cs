// SPDX-License-Identifier: Apache-2.0
// Sends the bodies of a Kinect v2 to kinalign (README.md beside this file). NOT BUILT on Windows by
// its authors. Three threads: the SDK's event copies a frame and returns at once, one thread sends,
// one hears pongs.
using System;
using System.Collections.Concurrent;
using System.Diagnostics;
using System.Net;
using System.Net.Sockets;
using System.Security.Cryptography;
using System.Text;
using System.Threading;
using Microsoft.Kinect;

namespace Kinalign
{
    public sealed class Options
    {
        public string Host;
        public int Port;
        public uint Sensor = 1;
        public bool Tcp, Orientations, Hands;

        /// Null: something else than what the README says.
        public static Options From(string[] arguments)
        {
            var options = new Options();
            try
            {
                for (int i = 0; i < arguments.Length; ++i)
                {
                    switch (arguments[i])
                    {
                        case "--host": options.Host = arguments[++i]; break;
                        case "--port": options.Port = int.Parse(arguments[++i]); break;
                        case "--sensor": options.Sensor = uint.Parse(arguments[++i]); break;
                        case "--tcp": options.Tcp = true; break;
                        case "--orientations": options.Orientations = true; break;
                        case "--hands": options.Hands = true; break;
                        default: return null;
                    }
                }
            }
            catch (Exception)
            {
                return null;
            }
            return options.Host != null && options.Port > 0 && options.Port < 65536 ? options : null;
        }
    }

    public sealed class Sender
    {
        private static readonly TimeSpan HelloEvery = TimeSpan.FromSeconds(1);
        private static readonly TimeSpan PingEvery = TimeSpan.FromMilliseconds(200);
        private const int MostWaiting = 60;  // frames, two seconds

        private readonly Options options;
        private readonly Messages messages;
        private readonly Stopwatch clock = Stopwatch.StartNew();
        private readonly BlockingCollection<Frame> waiting =
            new BlockingCollection<Frame>(new ConcurrentQueue<Frame>(), MostWaiting);
        private readonly Microsoft.Kinect.Body[] bodies;
        private readonly KinectSensor kinect;
        private readonly string sdk;
        private volatile Echo echo;
        private volatile bool stopped;
        private uint frames, hellos, pings;
        private long dropped, sent, pongs, failed;
        private Socket socket;

        public Sender(Options options, KinectSensor kinect)
        {
            this.options = options;
            this.kinect = kinect;
            messages = new Messages(options.Sensor, RandomSession());
            bodies = new Microsoft.Kinect.Body[kinect.BodyFrameSource.BodyCount];
            sdk = Printable(FileVersionInfo.GetVersionInfo(typeof(KinectSensor).Assembly.Location).FileVersion);
        }

        // ---- the SDK's event

        /// Never waits: where two seconds of frames have not been sent, this one is dropped. It has a
        /// number all the same, so that the host counts it as lost.
        public void FrameArrived(object source, BodyFrameArrivedEventArgs arguments)
        {
            long taken = clock.Elapsed.Ticks;
            using (BodyFrame arrived = arguments.FrameReference.AcquireFrame())
            {
                if (arrived == null) return;
                lock (bodies)  // should the SDK call from two threads
                {
                    arrived.GetAndRefreshBodyData(bodies);
                    Frame frame = Copied(arrived, taken);
                    frame.Sequence = frames++;
                    if (!waiting.TryAdd(frame)) Interlocked.Increment(ref dropped);
                }
            }
        }

        private Frame Copied(BodyFrame arrived, long taken)
        {
            var frame = new Frame();
            frame.DeviceTicks = arrived.RelativeTime.Ticks;  // 100 ns
            frame.TakenTicks = taken;
            frame.UtcMicroseconds = (DateTime.UtcNow.Ticks - 621355968000000000L) / 10;  // since 1970
            frame.Orientations = options.Orientations;
            frame.Hands = options.Hands;
            Vector4 plane = arrived.FloorClipPlane;
            if (plane.X != 0 || plane.Y != 0 || plane.Z != 0 || plane.W != 0)
            {
                frame.Floor = new float[] { plane.X, plane.Y, plane.Z, plane.W };
            }
            foreach (Microsoft.Kinect.Body body in bodies)
            {
                bool tracked = body != null && body.IsTracked && frame.Bodies.Count < Layout.MostBodies;
                if (tracked) frame.Bodies.Add(Copied(body));
            }
            return frame;
        }

        private static Body Copied(Microsoft.Kinect.Body body)
        {
            var copy = new Body();
            copy.Id = body.TrackingId;
            copy.ClippedEdges = (byte)body.ClippedEdges;
            copy.HandLeft = (byte)body.HandLeftState;
            copy.HandRight = (byte)body.HandRightState;
            copy.HandConfidence = (byte)((body.HandLeftConfidence == TrackingConfidence.High ? 1 : 0) |
                                         (body.HandRightConfidence == TrackingConfidence.High ? 2 : 0));
            for (int j = 0; j < Layout.Joints; ++j)
            {
                Joint joint = body.Joints[(JointType)j];
                copy.States[j] = (byte)joint.TrackingState;
                copy.Positions[3 * j] = joint.Position.X;
                copy.Positions[3 * j + 1] = joint.Position.Y;
                copy.Positions[3 * j + 2] = joint.Position.Z;
                Vector4 turned = body.JointOrientations[(JointType)j].Orientation;
                copy.Orientations[4 * j] = turned.W;
                copy.Orientations[4 * j + 1] = turned.X;
                copy.Orientations[4 * j + 2] = turned.Y;
                copy.Orientations[4 * j + 3] = turned.Z;
            }
            return copy;
        }

        // ---- the sending thread

        /// Until Stop: frames as they come, hellos and pings when they are due. What can't be sent is
        /// lost; a connection that broke is made again.
        public void Run()
        {
            TimeSpan nextHello = TimeSpan.Zero, nextPing = TimeSpan.Zero;
            while (!stopped)
            {
                Frame frame;
                bool any = waiting.TryTake(out frame, 20);
                try
                {
                    if (socket == null) Connect();
                    if (clock.Elapsed >= nextHello)
                    {
                        nextHello = clock.Elapsed + HelloEvery;
                        SendHello();
                    }
                    if (clock.Elapsed >= nextPing)
                    {
                        nextPing = clock.Elapsed + PingEvery;
                        SendPing();
                    }
                    if (any) SendFrame(frame);
                }
                catch (SocketException)
                {
                    ++failed;
                    Disconnect();
                    Thread.Sleep(200);
                }
            }
            Disconnect();
        }

        public void Stop()
        {
            stopped = true;
        }

        private void SendHello()
        {
            string serial = Printable(kinect.UniqueKinectId);
            Send(options.Tcp ? Bytes(messages.HelloLine(hellos, serial, sdk)) : messages.Hello(hellos, serial, sdk));
            ++hellos;
        }

        private void SendPing()
        {
            Echo newest = echo;
            long now = clock.Elapsed.Ticks;
            Send(options.Tcp ? Bytes(messages.PingLine(pings, now, newest)) : messages.Ping(pings, now, newest));
            ++pings;
        }

        private void SendFrame(Frame frame)
        {
            if (options.Tcp)
            {
                Send(Bytes(messages.FrameLine(frame, clock.Elapsed.Ticks)));
                return;
            }
            int most = Messages.BodiesInPart(frame), first = 0;
            byte part = 0;
            do
            {
                int count = Math.Min(most, frame.Bodies.Count - first);
                bool more = first + count < frame.Bodies.Count;
                Send(messages.FramePart(frame, first, count, part++, more, clock.Elapsed.Ticks));
                first += count;
            } while (first < frame.Bodies.Count);
        }

        private static byte[] Bytes(string line)
        {
            return Encoding.UTF8.GetBytes(line);
        }

        private void Send(byte[] bytes)
        {
            int at = 0;
            while (at < bytes.Length) at += socket.Send(bytes, at, bytes.Length - at, SocketFlags.None);
            Interlocked.Increment(ref sent);
        }

        private void Connect()
        {
            IPAddress address = Dns.GetHostAddresses(options.Host)[0];
            var made = options.Tcp
                ? new Socket(address.AddressFamily, SocketType.Stream, ProtocolType.Tcp)
                : new Socket(address.AddressFamily, SocketType.Dgram, ProtocolType.Udp);
            try
            {
                made.SendTimeout = 2000;
                if (options.Tcp) made.NoDelay = true;
                made.Connect(address, options.Port);  // of UDP: only from there is anything received
            }
            catch (SocketException)
            {
                made.Close();
                throw;
            }
            socket = made;
            var hearing = new Thread(delegate() { Hear(made); });
            hearing.IsBackground = true;
            hearing.Start();
        }

        private void Disconnect()
        {
            if (socket != null) socket.Close();
            socket = null;
        }

        // ---- the hearing thread

        private void Hear(Socket from)
        {
            var bytes = new byte[2048];
            var line = new StringBuilder();
            while (true)
            {
                int length;
                try
                {
                    length = from.Receive(bytes);
                }
                catch (SocketException)
                {
                    // UDP: no program has opened the port yet. The sending thread handles a broken TCP connection.
                    if (options.Tcp) return;
                    Thread.Sleep(50);
                    continue;
                }
                catch (ObjectDisposedException)
                {
                    return;
                }
                long received = clock.Elapsed.Ticks;  // first of all
                if (options.Tcp && length == 0) return;
                if (options.Tcp) HearLines(bytes, length, line, received);
                else Take(messages.ReadPong(bytes, length, received));
            }
        }

        private void HearLines(byte[] bytes, int length, StringBuilder line, long received)
        {
            foreach (char c in Encoding.ASCII.GetString(bytes, 0, length))
            {
                if (c != '\n')
                {
                    if (line.Length < bytes.Length) line.Append(c);
                    continue;
                }
                Take(messages.ReadPongLine(line.ToString(), received));
                line.Length = 0;
            }
        }

        private void Take(Echo heard)
        {
            if (heard == null) return;
            echo = heard;
            Interlocked.Increment(ref pongs);
        }

        // ---- small things

        public string State()
        {
            return string.Format("{0} frames, {1} dropped, {2} messages sent, {3} pongs, {4} failures",
                                 frames, Interlocked.Read(ref dropped), Interlocked.Read(ref sent),
                                 Interlocked.Read(ref pongs), failed);
        }

        private static uint RandomSession()
        {
            var bytes = new byte[4];
            using (var random = new RNGCryptoServiceProvider()) random.GetBytes(bytes);
            return BitConverter.ToUInt32(bytes, 0);
        }

        private static string Printable(string text)
        {
            var printable = new StringBuilder();
            foreach (char c in text ?? "")
            {
                if (c >= ' ' && c <= '~' && printable.Length < Layout.MostText) printable.Append(c);
            }
            return printable.ToString();
        }
    }

    public static class Program
    {
        public static int Main(string[] arguments)
        {
            Options options = Options.From(arguments);
            if (options == null)
            {
                Console.Error.WriteLine("KinectSender --host NAME --port NUMBER [--sensor NUMBER] [--tcp] " +
                                        "[--orientations] [--hands]");
                return 2;
            }
            KinectSensor kinect = KinectSensor.GetDefault();
            if (kinect == null)
            {
                Console.Error.WriteLine("expected a Kinect v2, found none");
                return 3;
            }
            var sender = new Sender(options, kinect);
            Console.CancelKeyPress += delegate(object source, ConsoleCancelEventArgs cancelled)
            {
                cancelled.Cancel = true;
                sender.Stop();
            };
            var sending = new Thread(sender.Run);
            using (BodyFrameReader reader = kinect.BodyFrameSource.OpenReader())
            {
                reader.FrameArrived += sender.FrameArrived;
                kinect.Open();
                Console.WriteLine("sensor {0} to {1}:{2}, {3}; Ctrl-C ends", options.Sensor, options.Host,
                                  options.Port, options.Tcp ? "lines over TCP" : "binary over UDP");
                sending.Start();
                while (!sending.Join(1000)) Console.Write("\r" + sender.State() + "   ");
            }
            kinect.Close();
            Console.WriteLine();
            return 0;
        }
    }
}
