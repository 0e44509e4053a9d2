// Built from client/src by client/build.js; change that instead.
/*! Holds parts of gl-matrix, of which this is the licence:

Copyright (c) 2015-2025, Brandon Jones, Colin MacKenzie IV.

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in
all copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN
THE SOFTWARE. */
/*! Holds parts of zarrita, of which this is the licence:

MIT License

Copyright (c) 2020-2023 Trevor Manz

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE. */
function qa(a){let e=a>>10&31,t=a&1023,r;return e===0?r=t*2**-24:e===31?r=t?NaN:1/0:r=(1024+t)*2**(e-25),a&32768?-r:r}var Re=Float32Array.
from({length:65536},(a,e)=>qa(e)),Kr=new Float32Array(1),qr=new Uint32Array(Kr.buffer);function Jr(a){Kr[0]=a;let e=qr[0]>>>
16&32768,t=qr[0]&2147483647;return t>=1199566848?e|(t>2139095040?32256:31744):t<947912704?e|Math.round(Math.abs(a)*2**24):
e|t-93952e4>>>13}function mr(a,e,t,r=1){let n=a.getParameter(a.MAX_TEXTURE_SIZE),s=a.getParameter(a.MAX_ARRAY_TEXTURE_LAYERS);
if(Math.max(e,t)>n||r>s)throw new Error(`a texture of ${e} x ${t} texels in ${r} layers is needed, but this graphics car\
d supports at most ${n} x ${n} in ${s}; show fewer nodes`)}function Qe(a,e,t){let{width:r,height:n,layers:s,channels:o,levels:i}=t;
mr(a,r,n,s);let c=a.TEXTURE_2D_ARRAY;a.bindTexture(c,e),a.texStorage3D(c,i+1,o===1?a.R16F:a.RGBA16F,r,n,s),a.texParameteri(
c,a.TEXTURE_MIN_FILTER,a.LINEAR_MIPMAP_LINEAR),a.texParameteri(c,a.TEXTURE_MAG_FILTER,a.LINEAR),a.texParameteri(c,a.TEXTURE_WRAP_S,
a.CLAMP_TO_EDGE),a.texParameteri(c,a.TEXTURE_WRAP_T,a.CLAMP_TO_EDGE)}var en=["coastlines","graticule"],Me={critical:"critical_points",separatrices:"separatrices",nullclines:"nullclines"},et={
saddle:8,orbit:4,leaving:2},Zr={float32:Float32Array,uint32:Uint32Array,float16:Uint16Array,uint16:Uint16Array,int16:Int16Array,
int8:Int8Array,uint8:Uint8Array};function pr({low:a,high:e,log:t}){if(!t)return n=>(n-a)/(e-a||1);let r=Math.log(e/a)||1;
return n=>Math.log(Math.max(n,a)/a)/r}function me(a){return a.variant.includes("FLOWTEX_SIGNFREE")}function Y(a){return Number(a.split("/")[1])}function Ee(a,e,{
scalars:t}){let[r,n,s="0"]=a.split("/"),o=t.choices[Number(s)]?.steps??t.steps;return r==="scalars"&&Number(n)===e&&o>1}
function pe(a){let[e,t,r,n,...s]=a.split("/");return e==="tile"?[[t,r,n].join("/"),s.join("/")]:null}function tn(a,e){let t=ArrayBuffer.
isView(e)?new Uint8Array(e.buffer,e.byteOffset,e.byteLength):new Uint8Array(e),{name:r,dtype:n,shape:s,digest:o}=a,i=Zr[n];
if(!i)throw new Error(`a part has the type "${n}"; expected ${Object.keys(Zr).join(", ")}`);return{name:r,shape:s,digest:o,
data:new i(t.slice().buffer)}}function rn(a){let[e,t]=fr(new Uint8Array(a)),r=t;return e.map(n=>{let s=new Uint8Array(a,
r,n.bytes);return r+=n.bytes,n.differences===void 0?tn(n,s):sn(n,s)})}function fr(a){let e=4+new DataView(a.buffer,a.byteOffset).
getUint32(0,!0);return[JSON.parse(new TextDecoder().decode(a.subarray(4,e))),e]}async function nn(a,e){return sn(a,new Uint8Array(
await Ka(e).arrayBuffer()))}function Ka(a){let e=atob(a),t=new Uint8Array(e.length);for(let r=0;r<t.length;r+=1)t[r]=e.charCodeAt(
r);return new Response(new Blob([t]).stream().pipeThrough(new DecompressionStream("gzip")))}var Qr={1:Uint8Array,2:Uint16Array,
4:Uint32Array};function sn(a,e){let{shape:t,differences:r=[0,0],scale:n=null}=a,s=t.reduce((u,m)=>u*m,1),o=s?e.length/s:
1;if(!(o in Qr))throw new Error(`the packing of the part "${a.name}" is invalid`);let[i,c]=t.length>2?t.slice(-2):[...t,
1].slice(-2),l=new Qr[o](s);for(let u=0,m=0;u<c;u+=1)for(let p=u;p<s;p+=c,m+=1){let f=0;for(let d=0;d<o;d+=1)f|=e[d*s+m]<<
8*d;l[p]=f>>>1^-(f&1)}let h=i*c;for(let u=0;u<r[0];u+=1)for(let m=h;m<s;m+=1)l[m]+=l[m-h];for(let u=0;u<r[1];u+=1)for(let m=0;m<
s;m+=h)for(let p=m+c;p<m+h;p+=1)l[p]+=l[p-c];return tn(a,n?Ja(l,n.map(u=>2**u)):l)}function Ja(a,e){let t=e.length;return a instanceof
Uint16Array?a.map((r,n)=>Jr((r<<16>>16)*e[n%t])):new Float32Array(new Float64Array(a).map((r,n)=>(r|0)*e[n%t]))}var dr=1e-6,tt=typeof Float32Array<"u"?Float32Array:Array;var ol=Math.PI/180,il=180/Math.PI;function on(a,e){if(a===e){var t=e[1],r=e[2],n=e[5];a[1]=e[3],a[2]=e[6],a[3]=t,a[5]=e[7],a[6]=r,a[7]=n}else a[0]=e[0],a[1]=
e[3],a[2]=e[6],a[3]=e[1],a[4]=e[4],a[5]=e[7],a[6]=e[2],a[7]=e[5],a[8]=e[8];return a}function cn(a,e,t){var r=t[0],n=t[1],s=t[2],o=Math.sqrt(r*r+n*n+s*s),i,c,l;return o<dr?null:(o=1/o,r*=o,n*=o,s*=o,i=Math.
sin(e),c=Math.cos(e),l=1-c,a[0]=r*r*l+c,a[1]=n*r*l+s*i,a[2]=s*r*l-n*i,a[3]=0,a[4]=r*n*l-s*i,a[5]=n*n*l+c,a[6]=s*n*l+r*i,
a[7]=0,a[8]=r*s*l+n*i,a[9]=n*s*l-r*i,a[10]=s*s*l+c,a[11]=0,a[12]=0,a[13]=0,a[14]=0,a[15]=1,a)}function eo(){var a=new tt(3);return tt!=Float32Array&&(a[0]=0,a[1]=0,a[2]=0),a}function ln(a){var e=a[0],t=a[1],r=a[2];return Math.sqrt(e*e+t*t+r*r)}function hn(a,e,t){return a[0]=e[0]-t[0],a[1]=e[1]-t[1],a[2]=e[2]-t[2],a}function un(a,e,t){return a[0]=e[0]*t,a[1]=e[1]*t,a[2]=e[2]*t,a}function mn(a,e,t,r){return a[0]=e[0]+t[0]*r,a[1]=e[1]+t[1]*
r,a[2]=e[2]+t[2]*r,a}function pn(a,e){var t=e[0],r=e[1],n=e[2],s=t*t+r*r+n*n;return s>0&&(s=1/Math.sqrt(s)),a[0]=e[0]*s,a[1]=e[1]*s,a[2]=e[2]*
s,a}function fn(a,e){return a[0]*e[0]+a[1]*e[1]+a[2]*e[2]}function dn(a,e,t){var r=e[0],n=e[1],s=e[2],o=t[0],i=t[1],c=t[2];
return a[0]=n*c-s*i,a[1]=s*o-r*c,a[2]=r*i-n*o,a}function bn(a,e,t){var r=e[0],n=e[1],s=e[2],o=t[3]*r+t[7]*n+t[11]*s+t[15];return o=o||1,a[0]=(t[0]*r+t[4]*n+t[8]*s+t[12])/
o,a[1]=(t[1]*r+t[5]*n+t[9]*s+t[13])/o,a[2]=(t[2]*r+t[6]*n+t[10]*s+t[14])/o,a}function br(a,e,t){var r=e[0],n=e[1],s=e[2];
return a[0]=r*t[0]+n*t[3]+s*t[6],a[1]=r*t[1]+n*t[4]+s*t[7],a[2]=r*t[2]+n*t[5]+s*t[8],a}var hl=(function(){var a=eo();return function(e,t,r,n,s,o){var i,c;for(t||(t=3),r||(r=0),n?c=Math.min(n*t+r,e.length):c=
e.length,i=r;i<c;i+=t)a[0]=e[i],a[1]=e[i+1],a[2]=e[i+2],s(a,a,o),e[i]=a[0],e[i+1]=a[1],e[i+2]=a[2];return e}})();var W=a=>a,re=()=>[0,0,0],gn=a=>new Array(a).fill(0),A=(a,e)=>fn(W(a),W(e)),O=a=>ln(W(a)),E=(a,e)=>hn(re(),W(a),W(e)),k=(a,e)=>un(
re(),W(a),e),N=(a,e)=>dn(re(),W(a),W(e)),C=a=>pn(re(),W(a)),T=(a,e,t=1)=>mn(re(),W(a),W(e),t);function rt(a,e,t){let r=cn(
gn(16),t*Math.PI/180,W(e));return r===null?re():bn(re(),W(a),r)}function F(a,e){let t=on(gn(9),a);return br(re(),W(e),t)}
function K(a,e){return br(re(),W(e),a)}function _(a,e,t){return Math.min(Math.max(a,e),t)}var ro="own cmap";var yn=256;function no({scalars:a},e,t,r){let{entries:n,flip:s,maps:o}=a,i=r?r.slice():new Uint8Array(4*n).fill(255),c=i.
length/4-1||1;return i.map((l,h)=>{let[u,m]=[h>>2,h&3],p=Math.round((s?c-u:u)/c*(yn-1));return m===3?l:e[3*(o.indexOf(t)*
yn+p)+m]})}function xn(a,{beyond:e}){let t=a.length/4,r=a instanceof Float32Array;return Float32Array.from({length:a.length+
12},(n,s)=>{let[o,i]=[s>>2,s&3],c=a[4*_(o-1,0,t-1)+i];return i===3?r?o?c:1:0:(o>t?e[o-t]:o?null:e[0])?.[i]??c/255})}function vn(a,e,t){let r={...a.scalars};e.scalars===!1&&(r.name=null);let n=r.choices.findIndex(({name:g})=>g===e.scalars);
if(n>=0){let{name:g,label:y,unit:x,steps:v,flat:w}=r.choices[n];Object.assign(r,{name:g,label:y,unit:x,steps:v,flat:w,number:n,
auto:!0})}if(e.cmap&&(r.cmap=e.cmap),Array.isArray(e.clim)&&([r.low,r.high]=e.clim),e.clim!==void 0&&(r.auto=!e.clim),r.
auto&&r.choices[r.number]){let{cmap:g="",least:y,...x}=r.choices[r.number],v=r.log&&y>0,[w,M]=v?[y,x.most]:[x.low,x.high],
S=(w<0&&M>0||r.diverging.includes(g))&&r.diverging.includes(r.cmap),R=Math.max(-w,M);[r.low,r.high]=S?[-R,R]:[w,M]}let{coastlines:s=a.
earth?.coastlines,graticule:o=a.earth?.graticule}=e,i=a.earth&&{...a.earth,coastlines:s,graticule:o},{opacity:c=a.opacity}=e,
l={scalars:r,earth:i,opacity:c},[h,u]=[t.get("maps"),t.get("cmap")?.data],m=u instanceof Float32Array,p=m&&(e.clim!==void 0||
e.scalars!==void 0);if(!h||!(e.cmap||p))return{colours:l,part:null};p&&Object.assign(r,{ticks:[],beyond:[null,null,r.beyond[2]]});
let f=m&&!p,d=e.cmap?no(a,h.data,e.cmap,f?u:void 0):Uint8Array.from(u??[]),b=[ro,e.cmap,f].join();return{colours:l,part:{
name:"cmap",data:d,shape:[d.length/4,4],digest:b}}}var gr=[0,0,1],wn=Math.sin(89*Math.PI/180),so=.2;var fe=a=>Math.tan(a*Math.PI/360),de=class{flat;limits;aspect;state;start;pick=null;globe;homeHeight;nearest;constructor(e,t,r,n=1,s=0){
this.state=yr(e),this.start=yr(e),this.limits=t,this.flat=r,this.globe=s,this.aspect=n,this.homeHeight=this.height,this.
nearest=this.distance/t.closest}get height(){let{parallel:e,parallel_scale:t,view_angle:r}=this.state;return e?t:this.distance*
fe(r)}get distance(){return O(E(this.state.focal_point,this.state.position))}get zoom(){return this.homeHeight/this.height}get axes(){
let e=C(E(this.state.focal_point,this.state.position)),t=C(N(e,this.state.up));return[t,N(t,e),e]}sight(e){let{parallel:t,
position:r,view_angle:n}=this.state;return t?{eye:null,halfHeight:this.height,pixels:e}:{eye:r,halfHeight:fe(n),pixels:e}}get planes(){
let[e,t,r]=this.axes,{parallel:n,parallel_scale:s,view_angle:o}=this.state,{position:i,focal_point:c}=this.state,l=n?s:fe(
o);return[e,k(e,-1),t,k(t,-1)].map((h,u)=>{let m=u<2?l*this.aspect:l;if(n)return[...h,m-A(h,c)];let p=T(h,r,m);return[...p,
-A(p,i)]})}get eye(){return this.state.parallel?[...k(this.axes[2],-1),0]:[...this.state.position,1]}at(e){let t=this.axes[2];
if(this.state.parallel)return{height:this.height,ray:t};let r=E(e,this.state.position);return{height:A(r,t)*fe(this.state.
view_angle),ray:C(r)}}project(e){let[t,r]=this.axes,{height:n}=this.at(e);if(!(n>0))return null;let{parallel:s,position:o,
focal_point:i}=this.state,c=E(e,s?i:o);return[A(t,c)/n/this.aspect,A(r,c)/n]}pan(e,t){let[r,n]=this.axes,{height:s}=this;
this.shift(T(k(r,e*this.aspect*s),n,t*s))}rotate(e,t){if(this.globe)return this.roam(e,t);let{state:r,limits:n}=this,s=C(
r.up),o=E(r.position,r.focal_point);o=rt(o,s,-n.turn*e*Math.min(this.aspect,n.widest_turn));let i=C(N(s,o));o=rt(o,i,n.turn*
t),r.position=T(r.focal_point,o),r.up=C(N(o,i))}roam(e,t){let{state:r,limits:n,globe:s}=this,o=O(r.position),i=Math.max(
o-s,0)*fe(r.view_angle),c=r.parallel?r.parallel_scale:i,l=Math.min(c/s*180/Math.PI,n.turn),h=Math.hypot(r.position[0],r.
position[1])/o,u=Math.min(l*this.aspect/Math.max(h,so),n.turn);this.turn(gr,-u*e);let[m]=this.axes,p=Math.abs(r.position[2])/
o,f=yr(r);this.turn(m,l*t),Math.abs(r.position[2])/o>Math.max(wn,p)&&(this.state=f);let[,,b]=this.axes,g=T(gr,b,-A(gr,b));
O(g)>1-wn&&(this.state.up=C(g))}turn(e,t){let{state:r}=this;for(let n of["position","focal_point","up"])r[n]=rt(r[n],e,t)}zoomBy(e,t=0,r=0){
if(!Number.isFinite(e)||e<=0)return;this.flat||this.focusAt(t,r);let{farthest_zoom:n,deepest_zoom:s}=this.limits,o=_(e,n/
this.zoom,s/this.zoom),[i,c,l]=this.axes,h=this.height*(1-1/o);this.shift(T(k(i,t*this.aspect*h),c,r*h)),this.state.parallel?
this.state.parallel_scale/=o:this.approach(this.height/o,l)}ray(e,t){let[r,n,s]=this.axes,{height:o,state:i}=this,c=T(T(
i.focal_point,r,e*this.aspect*o),n,t*o);return i.parallel?[T(c,s,-this.distance),s]:[T(i.position,[0,0,0]),C(E(c,i.position))]}approach(e,t){
let r=Math.max(e/fe(this.limits.view_angle),this.nearest);this.state.position=T(this.state.focal_point,t,-r),this.state.
view_angle=Math.atan(e/r)*360/Math.PI}focusAt(e,t){let r=this.pick?.(e,t);if(!r)return;let n=this.axes[2],s=A(E(r,this.state.
position),n);s>0&&(this.state.focal_point=T(this.state.position,n,s))}shift(e){this.state.focal_point=T(this.state.focal_point,
e),this.state.position=T(this.state.position,e)}};function yr(a){let{position:e,focal_point:t,up:r}=a;return{...a,position:[
...e],focal_point:[...t],up:[...r]}}function G(a,e,t){let{state:r,aspect:n}=e,{center:s,extent:o,frame:i}=a,[c,l,h]=e.axes.map(S=>F(i,S)),u=S=>E(F(i,E(S,s)),
t),m=u(r.focal_point),p=k(t,-1),f=Math.max(.51*o,a.reach??0),d=new Array(16).fill(0),b=r.parallel?r.parallel_scale:fe(r.
view_angle);if([c.map(S=>S/b/n),l.map(S=>S/b)].forEach((S,R)=>{for(let L=0;L<3;L+=1)d[4*L+R]=S[L];d[12+R]=-A(S,m)}),r.parallel){
for(let S=0;S<3;S+=1)d[4*S+2]=h[S]/f;return d[14]=-A(h,p)/f,d[15]=1,d}let y=u(r.position),x=A(E(p,y),h),v=Math.max(x+f,.001*
f),w=Math.max(x-f,.001*v),M=(v+w)/(v-w),P=-2*v*w/(v-w);for(let S=0;S<3;S+=1)d[4*S+2]=h[S]*M,d[4*S+3]=h[S];return d[15]=-A(
h,y),d[14]=d[15]*M+P,d}function Mn({center:a,frame:e},t,r,n,s){let[o,i]=t.axes,{height:c,state:l,aspect:h}=t,[u,m]=[k(o,
2*c*h/n),k(i,2*c/s)],p=T(T(E(l.focal_point,a),u,-n/2),m,-s/2);return{u_rayCorner:E(F(e,p),r),u_rayX:F(e,u),u_rayY:F(e,m)}}var oe=8,Sn=9,ao=.2,oo=1.4,En=55,io=125,co=.5,lo=4,Tn=4e-5,An=2e-6;function _n(a,e,t,r,n){let s=Math.max(n-e,Math.min(e/
2,n),2)/a;if(t*(r+oe)<=s)return{scale:1,samples:r};let o=Math.min(Sn,r),i=Math.sqrt(s/(o+oe)/t);return i<1?{scale:Math.max(
i,ao),samples:o}:{scale:1,samples:_(Math.floor(s/t-oe),o,r)}}function Pn(a,e,t,r,n){if(!n)return En;let s=Math.min(Sn,r),
o=e+a*t*co**2*(s+oe);return _(o,En,io)}function Rn(a,e,t,r){return Math.max(Math.floor(a/(e*t*(r+oe))),lo)}function Ln(a){
return(2*a+oe)/(a+oe)}function kn(a,e,t,r,n){let s=Math.max(e,.05)/(t*(r+oe)*n);return a+(s-a)*(s>a?.7:.3)}function On(a,e,t){
let[r,n,s]=[a.grain,a.spacing,a.samples].map(Number),o=Math.max(r*t,Math.min(r,1)),c=s*n*r*t/(e*o);return{u_grain:o,u_spacing:_(
c,.1,Math.max(oo,n))}}var ho=`#version 300 es
precision highp float;
precision highp int;
`,uo=["flowtexPosition","flowtexCoordinate","flowtexNormal","flowtexScalar","flowtexCorners","flowtexRadius"],Q=["u_slic\
es","u_slicesNext","u_image","u_stepImage","u_cmap","u_shares","u_along","u_nodes","u_corners","u_open","u_places","u_de\
pths","u_colours","u_strides","u_below","u_texture","u_source","u_means"],Se=class{graphics;entries=new Map;parallel=null;constructor(e){
this.graphics=e}findFeatures(){this.parallel=this.graphics.context.getExtension("KHR_parallel_shader_compile")}clear(){this.
entries.clear()}dispose(){for(let e of this.entries.values()){for(let t of e.shaders)this.graphics.free("Shader",t);this.
graphics.free("Program",e.program)}this.clear()}get(e,t,...r){let n=[e,t,...r].join("\0"),s=this.entries.get(n);return s||
this.entries.set(n,s=this.build(e,t,r)),!s.ready&&!s.error&&this.finish(s),s}build(e,t,r){let{graphics:n}=this,s=n.context,
o=n.counted(s.createProgram()),i=[s.VERTEX_SHADER,s.FRAGMENT_SHADER],c=ho+r.map(u=>`#define ${u}
`).join(""),l=[e,t].map((u,m)=>{let p=n.counted(s.createShader(i[m]));return s.shaderSource(p,u.startsWith("#version")?u:
c+u),s.compileShader(p),s.attachShader(o,p),p});return uo.forEach((u,m)=>s.bindAttribLocation(o,m,u)),s.linkProgram(o),{
program:o,shaders:l,uniforms:new Map,...{ready:!1,error:"",warm:!1,price:Tn}}}finish(e){let t=this.graphics.context,{program:r}=e,
n=this.parallel?.COMPLETION_STATUS_KHR;if(n&&!t.getProgramParameter(r,n))return;if(!t.getProgramParameter(r,t.LINK_STATUS)){
if(t.isContextLost())return;let i=[...e.shaders.map(c=>t.getShaderInfoLog(c)),t.getProgramInfoLog(r)].filter(Boolean).join(
`
`);e.error=i||"the driver gave no reason";return}for(let o of e.shaders)this.graphics.free("Shader",o);e.shaders=[];let s=t.
getProgramParameter(r,t.ACTIVE_UNIFORMS);for(let o=0;o<s;o+=1){let i=t.getActiveUniform(r,o),c=i&&t.getUniformLocation(r,
i.name);!i||!c||e.uniforms.set(i.name.replace(/\[0\]$/,""),{location:c,type:i.type})}t.useProgram(r),Q.forEach((o,i)=>{let c=e.
uniforms.get(o),l=c?.type===t.FLOAT_VEC2||c?.type===t.INT_VEC2;c&&!l&&t.uniform1i(c.location,i)}),e.ready=!0}use(e,t){let r=this.
graphics.context;r.useProgram(e.program);for(let[n,s]of Object.entries(t)){let o=e.uniforms.get(n);if(!o)continue;let{location:i,
type:c}=o,l=typeof s=="object"?s:[Number(s)];c===r.FLOAT?r.uniform1fv(i,l):c===r.FLOAT_VEC2?r.uniform2fv(i,l):c===r.FLOAT_VEC3?
r.uniform3fv(i,l):c===r.FLOAT_VEC4?r.uniform4fv(i,l):c===r.FLOAT_MAT4?r.uniformMatrix4fv(i,!1,l):c===r.INT_VEC2?r.uniform2iv(
i,l):r.uniform1i(i,l[0])}}};var mo=4,po=45,fo=[4,68],bo=Symbol.for("flowtex.gl/3");function Fn(a){return["EXT_color_buffer_float","EXT_color_buffer_\
half_float"].some(e=>a.getExtension(e)!==null)}var xr=class{canvas=document.createElement("canvas");gl;programs;users=new Set;waiting=new Set;common=new Map;stock=new Map;tracings=new Map;objects=0;isLost=!1;scheduled=0;picker=null;smooth=null;constructor(){
this.canvas.width=this.canvas.height=16;let e=this.canvas.getContext("webgl2",{alpha:!0,antialias:!1,powerPreference:"hi\
gh-performance"});this.gl=e&&Fn(e)?e:null,this.programs=new Se(this),this.gl&&this.programs.findFeatures(),this.canvas.addEventListener(
"webglcontextlost",t=>{t.preventDefault(),this.isLost=!0,this.objects=0,this.programs.clear(),this.common.clear(),this.tracings.
clear(),this.picker=this.smooth=null;for(let r of this.users)r.lost()}),this.canvas.addEventListener("webglcontextrestor\
ed",()=>{this.isLost=!1,this.gl&&Fn(this.gl)&&this.programs.findFeatures();for(let t of this.users)t.change()})}get context(){
if(!this.gl)throw new Error("WebGL2 is not available");return this.gl}leave(e){if(this.users.delete(e),this.waiting.delete(
e),!this.users.size){cancelAnimationFrame(this.scheduled),this.scheduled=0,this.programs.dispose();for(let t of[this.picker,
this.smooth])t&&this.freeTarget(t);this.picker=this.smooth=null,this.canvas.width=this.canvas.height=16}}request(e){this.
waiting.add(e),this.scheduled||=requestAnimationFrame(t=>this.run(t))}run(e){this.scheduled=0;let t=performance.now()+po;
for(let r of[...this.waiting])if(this.waiting.delete(r),r.frame(e,t),performance.now()>t)break;this.waiting.size&&(this.
scheduled||=requestAnimationFrame(r=>this.run(r)))}counted(e){if(e===null)throw new Error("the graphics card has no memo\
ry left, or the context is lost");return this.objects+=1,e}free(e,t){if(t===null||this.isLost||!this.gl)return;this.objects-=
1,this.gl[`delete${e}`](t)}hold(e){if(!e.digest)return e;let t=this.stock.get(e.digest)??{part:e,users:0};return this.stock.
set(e.digest,{...t,users:t.users+1}),t.part}release(e){let t=e&&this.stock.get(e.digest);!e||!t||(t.users-=1,t.users||this.
stock.delete(e.digest))}target(e,t,r,n){let s=this.context,o=this.counted(s.createFramebuffer());s.bindFramebuffer(s.FRAMEBUFFER,
o);let c=[[e,s.COLOR_ATTACHMENT0],[s.DEPTH_COMPONENT24,s.DEPTH_ATTACHMENT]].map(([l,h])=>{let u=this.counted(s.createRenderbuffer());
return s.bindRenderbuffer(s.RENDERBUFFER,u),s.renderbufferStorageMultisample(s.RENDERBUFFER,n,l,t,r),s.framebufferRenderbuffer(
s.FRAMEBUFFER,h,s.RENDERBUFFER,u),u});return{frame:o,buffers:c}}freeTarget(e){this.free("Framebuffer",e.frame);for(let t of e.
buffers)this.free("Renderbuffer",t)}bindSmooth(e,t){let r=this.context,n=this.smooth;if(!n||n.width<e||n.height<t){let[s,
o]=[Math.max(e,n?.width??0),Math.max(t,n?.height??0)];n&&this.freeTarget(n);let i=this.target(r.RGBA8,s,o,mo);this.smooth=
{...i,width:s,height:o}}r.bindFramebuffer(r.FRAMEBUFFER,this.smooth?.frame??null)}copySmooth(e,t){let r=this.context;r.bindFramebuffer(
r.READ_FRAMEBUFFER,this.smooth?.frame??null),r.bindFramebuffer(r.DRAW_FRAMEBUFFER,null),r.disable(r.SCISSOR_TEST),r.blitFramebuffer(
0,0,e,t,0,0,e,t,r.COLOR_BUFFER_BIT,r.NEAREST),r.bindFramebuffer(r.FRAMEBUFFER,null)}numbers(e,t=1,r=1){let n=this.context;
this.picker??=this.target(n.RGBA32UI,...fo,0),n.bindFramebuffer(n.FRAMEBUFFER,this.picker.frame),n.viewport(0,0,t,r),n.disable(
n.SCISSOR_TEST),n.enable(n.DEPTH_TEST),n.clearBufferuiv(n.COLOR,0,[0,0,0,0]),n.clear(n.DEPTH_BUFFER_BIT),e();let s=new Uint32Array(
4*t*r);return n.readPixels(0,0,t,r,n.RGBA_INTEGER,n.UNSIGNED_INT,s),n.bindFramebuffer(n.FRAMEBUFFER,null),s}};function Nn(){
let a=globalThis;return a[bo]??=new xr}var nt=class{size;poles;rays;nodes;isAlongJ;cells;lines;constructor(e,t,r){let[n,s]=t;this.poles=e,this.nodes=t,this.rays=
r,this.isAlongJ=e[0]?.component!==0,[this.lines,this.cells]=this.isAlongJ?[n,s-1]:[s,n-1];let o=e.reduce((i,c)=>i+this.depth(
c)+1,0);this.size={width:s+(this.isAlongJ?0:o),height:n+(this.isAlongJ?o:0)}}laidOut(e){if(!this.poles.length)return e;let[
t,r]=this.nodes,{width:n,height:s}=this.size,o=new Float32Array(4*n*s);for(let i=0;i<t;i+=1)o.set(e.subarray(4*r*i,4*r*(i+
1)),4*n*i);return this.poles.forEach((i,c)=>this.fill(o,i,c)),o}fastest(e){let t=0;for(let r=0;r<(this.isAlongJ?this.size.
height:this.size.width);r+=1){let n=s=>(r-s.line)*s.inward<s.near;if(!(r<this.lines&&this.poles.some(n)))for(let s=0;s<=
this.cells;s+=1){let o=this.at(r,s);t=Math.max(t,Math.abs(e[o]),Math.abs(e[o+1]))}}return t}at(e,t){return 4*(this.isAlongJ?
e*this.size.width+t:t*this.size.width+e)}depth({near:e}){return Math.min(e+3,this.lines-1)}shift(e){let t=this.poles.slice(
0,e).reduce((s,o)=>s+this.depth(o)+1,0),{inward:r,line:n}=this.poles[e];return this.lines+t-(r>0?n:n-this.depth(this.poles[e]))}ray(e,t){
let r=2*(e*(this.cells+1)+t);return[this.rays[r],this.rays[r+1]]}fill(e,t,r){let{cells:n}=this,{line:s,inward:o,component:i}=t,
[c,l]=[this.shift(r),this.still(e,t,r)];for(let h=0;h<=this.depth(t);h+=1)for(let u=0;u<=n;u+=1){let m=this.at(s+o*h,u),
p=this.at(s+o*h+c,u),[f,d]=[e[m+1-i],e[m+i]],[b,g,y]=[u,(u+1)%n,(u+n-1)%n].map(x=>this.ray(r,x));for(let x of[0,1]){let v=(g[x]-
y[x])/2;e[p+x]=h?o*d*b[x]+f*h*v:l[x]}e.copyWithin(p+2,m+2,m+4)}}still(e,{line:t,inward:r,component:n},s){let[o,i,c,l,h]=[
0,0,0,0,0];for(let m=0;m<this.cells;m+=1){let[p,f]=this.ray(s,m),d=p*p+f*f,b=e[this.at(t,m)+n]*r;[l,h]=[l+b*p,h+b*f],[o,
i,c]=[o+p*p/d,i+p*f/d,c+f*f/d]}let u=o*c-i*i;return[(c*l-i*h)/u,(o*h-i*l)/u]}get raysSize(){return[this.cells+1,Math.max(
this.poles.length,1)]}get angles(){let{cells:e}=this,[t,r]=this.raysSize,n=new Float32Array(4*t*r);return this.poles.forEach(
(s,o)=>{let i=[];for(let c=0;c<=e;c+=1){let[l,h]=this.ray(o,c),u=Math.atan2(h,l);for(;u<i[c-1];)u+=2*Math.PI;i.push(u)}i.
forEach((c,l)=>{let h=i[0]+2*Math.PI*l/e+1e-6,u=i.findLastIndex(m=>m<=h);n.set([c,Math.hypot(...this.ray(o,l)),u],4*(o*t+
l))})}),n}get uniforms(){let e=this.poles.flatMap(({line:r,inward:n,near:s},o)=>[r,n,s,this.shift(o)]),t=this.poles.flatMap(
({plane:r})=>r);for(;e.length<8;)e.push(0);for(;t.length<12;)t.push(0);return{u_poles:e,u_planes:t,u_polar:Number(this.isAlongJ)}}};var In=32767,[go,yo,xo,vo]=[0,1,2,3],wo=2,Mo=8,Eo=4,So=4,To=64,Ao=64,_o=2e4,Po=1e30,Cn=1e-5;function Un(a,e,t){let[r,n]=t,
s=a.shape[1],[o,i]=e.drawn,c=new Float64Array(r*n*3);for(let l=0,h=0;l<r;l+=1){let u=3*((l+o+1)*s+i+1);for(let m=0;m<3*n;m+=
1)c[h++]=a.data[u+m]+e.middle[m%3]}return{data:c,shape:[r,n,3]}}function Vn(a,e,t){let[r,n]=t,s=3*a.shape[1],[o,i]=e.drawn,
c=new Int16Array(r*n*3);for(let l=0,h=0;l<r;l+=1)for(let u=0;u<n;u+=1,h+=3){let m=s*(l+o+1)+3*(u+i+1),p=b=>[0,1,2].map(g=>a.
data[m+b+g]-a.data[m-b+g]),f=N(p(3),p(s)),d=O(f)||1;for(let b=0;b<3;b+=1)c[h+b]=Math.round(f[b]/d*In)}for(let{component:l,
line:h,inward:u}of e.poles??[]){let[m,p]=l?[h-o,n]:[h-i,r];if(m<0||m>=(l?r:n))continue;let f=(y,x)=>3*(l?y*n+x:x*n+y),d=[
0,0,0];for(let y=0;y<p;y+=1)for(let x=0;x<3;x+=1)d[x]+=c[f(m+u,y)+x];let b=O(d)||1,g=d.map(y=>Math.round(y/b*In));for(let y=0;y<
p;y+=1)c.set(g,f(m,y))}return{data:c,shape:[r,n,3]}}function ie({slices:a},e){let{trace:t,times:r,lags:n}=a;if(!t?.pathlines||
!t.timed)return[e];let s=n[n.length-1]*t.timed.unit,o=r.map(c=>Math.abs(c-r[e])<s),i=c=>o[c]||o[c-1]||o[c+1];return[...r.
keys()].filter(i)}function Ro({slices:a},e,t,r,n){let{trace:s,times:o}=a;if(!s?.pathlines||!s.timed)return[{from:r,to:n,
steps:[e,e],between:[0,1]}];let i=[],{unit:c}=s.timed,l=h=>t*(o[h]-o[e])/c;for(let h=e;r<n;h+=t){let u=!(h+t in o),m=u?n:
l(h+t);if(m<=r+Cn*n)continue;let p=u?[0,1]:[l(h),m],f=m>=n-Cn*n;i.push({from:r,to:f?n:m,steps:[h,u?h:h+t],between:p}),r=
f?n:m}return i}function st({programs:a},e,t){let{fullVertex:r,trace:n="",layers:s=""}=e.shaders,o=(c,...l)=>{let h=l.filter(
m=>typeof m=="string"),u=a.get(r,c,...h);if(u.error)throw new Error(`the tracer cannot be built: ${u.error}`);return u},
i=t.poles!==void 0&&"FLOWTEX_POLES";return{follow:o(n,i,t.pathlines&&"FLOWTEX_PATHLINES"),compose:t.pathlines?null:o(n,i,
"FLOWTEX_COMPOSED"),slopes:o(s,"FLOWTEX_SLOPES"),tangents:o(s,i)}}var at=class{graphics;header;trace;find;textures=new Set;frames=[];result=null;passes;flows=new Map;fastest=1;poles;constructor(e,t,r,n,s){
this.graphics=e,this.header=t,this.trace=r,this.find=n,this.poles=new nt(r.poles??[],r.nodes,n("rays")?.data??[]),this.passes=
this.slices(s)}advance(e){if(!Object.values(st(this.graphics,this.header,this.trace)).every(r=>r?.ready??!0))return null;
let t=this.graphics.context;try{do{let{done:r,value:n}=this.passes.next();if(t.isContextLost())return null;if(r)return this.
result=null,n}while(performance.now()<e);return null}finally{this.unbind()}}dispose(){for(let e of this.textures)this.graphics.
free("Texture",e);for(let e of this.frames)this.graphics.free("Framebuffer",e);this.result&&!this.graphics.context.isContextLost()&&
this.graphics.context.deleteTexture(this.result),this.result=null,this.textures.clear(),this.frames.length=0}data(e){let t=this.
find(e);if(!t)throw new Error(`the part "${e}" of the scene is missing`);return t.data}numbers(e){let t=this.data(e);return t instanceof
Float32Array?t:new Float32Array(t).map(r=>Re[r])}texture(e,t,r,n){let s=this.graphics.context,o=this.graphics.counted(s.
createTexture());return this.textures.add(o),s.activeTexture(s.TEXTURE0),s.bindTexture(s.TEXTURE_2D,o),s.texStorage2D(s.
TEXTURE_2D,1,r,e,t),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MIN_FILTER,s.NEAREST),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MAG_FILTER,
s.NEAREST),n&&s.texSubImage2D(s.TEXTURE_2D,0,0,0,e,t,s.RGBA,s.FLOAT,n),o}frame(){let e=this.graphics.context,t=this.graphics.
counted(e.createFramebuffer());return this.frames.push(t),e.bindFramebuffer(e.FRAMEBUFFER,t),t}target(e,t){let r=this.graphics.
context,n=this.texture(e,t,r.RGBA32UI,null),s=this.frame();return r.framebufferTexture2D(r.FRAMEBUFFER,r.COLOR_ATTACHMENT0,
r.TEXTURE_2D,n,0),[n,s]}unbind(){let e=this.graphics.context;for(let t=0;t<Mo;t+=1)e.activeTexture(e.TEXTURE0+t),e.bindTexture(
e.TEXTURE_2D,null),e.bindTexture(e.TEXTURE_2D_ARRAY,null);e.bindFramebuffer(e.FRAMEBUFFER,null)}flow(e){let{trace:t}=this,
r=this.numbers(`flow/${e}`),n=this.data("unit"),s=r.length/n.length,o=new Float32Array(4*n.length);for(let c=0,l=0;c<n.length;c+=
1,l+=s){let h=r[l+2],u=Re[n[c]]*t.unit;o[4*c]=r[l]*h/u,o[4*c+1]=r[l+1]*h/u,o[4*c+2]=h,o[4*c+3]=t.timed?t.timed.unit:u}let i=this.
poles.laidOut(o);return t.timed&&(this.fastest=Math.max(this.fastest,this.poles.fastest(i)*t.timed.speed*t.timed.unit)),
i}wholeSpeed(e){let t=this.numbers(`flow/${e}`),r=this.data("unit").length,n=t.length/r,s=Number(this.trace.uncertain??!1),
o=new Float32Array(4*r);for(let i=0;i<r;i+=1)o[4*i]=t[(i+1)*n-1-s],o[4*i+1]=s*t[(i+1)*n-1];return o}cells(){let[e,t]=this.
trace.nodes,[r,n]=["open","nearest"].map(o=>this.find(o)?.data),s=new Float32Array(4*e*t);for(let o=0;o<e*t;o+=1){s[4*o]=
r?r[o]:1;for(let i of[0,1])s[4*o+1+i]=n?n[2*o+i]:0}return s}padded(){let e=this.data("padded"),t=new Float32Array(e.length/
3*4);for(let r=0;r<e.length/3;r+=1)for(let n=0;n<3;n+=1)t[4*r+n]=e[3*r+n];return t}flowTexture(e){let{width:t,height:r}=this.
poles.size,n=this.graphics.context,o=this.flows.get(e)??this.texture(t,r,n.RGBA32F,this.flow(e));this.flows.delete(e),this.
flows.set(e,o);for(let[i,c]of this.flows){if(this.flows.size<=So)break;this.flows.delete(i),this.textures.delete(c),this.
graphics.free("Texture",c)}return o}partsOf({from:e,to:t}){let r=_(Math.ceil((t-e)*this.fastest/To),1,Ao),n=s=>s===r?t:e+
(t-e)*s/r;return Array.from({length:r},(s,o)=>[n(o),n(o+1)])}*slices(e){let{graphics:t,trace:r,header:n}=this,s=t.context,
{geometry:o,slices:i}=n,[c,l]=r.nodes,[h,u]=[o.rows.size,o.columns.size],m={width:u,height:h,layers:i.count,channels:4,levels:o.
levels},p=s.createTexture();this.result=p,s.activeTexture(s.TEXTURE0),Qe(s,p,m);let{poles:f}=this,d=this.texture(f.size.
width,f.size.height,s.RGBA32F,this.flow(e)),b=this.texture(...f.raysSize,s.RGBA32F,f.angles),g=[this.texture(l,c,s.RGBA32F,
this.cells()),this.texture(l+2,c+2,s.RGBA32F,this.padded()),this.texture(l,c,s.RGBA32F,this.wholeSpeed(e))],y=[0,1,2,3,4].
map(()=>this.target(l,c)),{lags:x,sides:v,count:w}=i,M={u_flow:0,u_cells:1,u_padded:2,u_speed:3,u_before:4,u_last:5,u_earlier:5,
u_flowNext:6,u_rays:7,...f.uniforms,u_longest:r.longest??Po,u_nodes:[l,c],u_closed:[Number(r.closed[1]),Number(r.closed[0])],
u_first:[r.first[1],r.first[0]],u_texels:[u,h],u_offsetJ:r.offset.slice(0,3),u_offsetI:r.offset.slice(3,6),u_timed:r.timed?.
speed??0,u_rest:r.rest,u_pace:r.pace,u_unit:i.unit,u_cell:i.cell/i.unit,u_planar:Number(o.planar),u_mostReach:2*x[x.length-
1]},P=([V,Z],we,ue,Pe)=>{s.viewport(0,0,V,Z);for(let X of[s.SCISSOR_TEST,s.DEPTH_TEST,s.BLEND,s.CULL_FACE])s.disable(X);
we.forEach((X,te)=>{s.activeTexture(s.TEXTURE0+te),s.bindTexture(s.TEXTURE_2D,X)}),s.bindVertexArray(null),t.programs.use(
ue,{...M,...Pe}),s.drawArrays(s.TRIANGLES,0,3)},S=this.frame(),R=(V,Z,we,ue)=>{s.bindFramebuffer(s.FRAMEBUFFER,S),s.framebufferTextureLayer(
s.FRAMEBUFFER,s.COLOR_ATTACHMENT0,p,0,V),P([u,h],[d,...g,...we],Z,ue)},{follow:L,compose:U,slopes:I,tangents:J}=st(t,n,r);
R(0,J,[],{u_inCells:0}),w>1+v*x.length&&R(w-1,J,[],{u_inCells:1});let ae=0;for(let V=0;V<v;V+=1){let Z=V?1:-1,we=1+V*x.length,
[ue,Pe,X]=[y[0],y[0],y[0]];for(let[te,Je]of x.entries()){let[$r,jr]=[x[te-1]??0,x[te-2]??0],Xr=Je>Eo&&jr>0?U:null,Ze=X;for(let hr of Ro(
n,e,Z,$r,Je)){let[Wa,$a]=hr.steps.map(ur=>this.flowTexture(ur)),ja=Xr?[[$r,Je]]:this.partsOf(hr);for(let[ur,Xa]of ja){let Yr=y.
find(Ya=>![ue,Pe,X,Ze].includes(Ya))??y[0];s.bindFramebuffer(s.FRAMEBUFFER,Yr[1]),P([l,c],[Wa,...g,Ze[0],Pe[0],$a,b],Xr??
L,{u_lagEarlier:jr,u_from:ur,u_to:Xa,u_side:Z,u_between:hr.between}),Ze=Yr,!((ae+=c*l)<_o)&&(s.readPixels(0,0,1,1,s.RGBA_INTEGER,
s.UNSIGNED_INT,new Uint32Array(4)),ae=0,yield)}}[Pe,X]=[X,Ze],te||(ue=X);let Ga=r.uncertain&&te===wo,za=te===1&&!V?yo:Ga?
vo:go;te&&R(we+te,I,[X[0],X[0]],{u_fourth:za,u_lag:Z*Je})}R(we,I,[ue[0],X[0]],{u_fourth:xo,u_lag:Z*x[0]})}return s.activeTexture(
s.TEXTURE0),s.bindTexture(s.TEXTURE_2D_ARRAY,p),m.levels&&s.generateMipmap(s.TEXTURE_2D_ARRAY),p}};var Lo={slices:[12,4],flow:[100,24]},ko=24,ot=class{all=new Map;graphics;constructor(e){this.graphics=e}set(e){let{name:t,
digest:r}=e;if(r&&this.all.get(t)?.digest===r)return!1;let n=this.graphics.hold(e);return this.remove(t),this.all.set(t,
n),!0}remove(e){this.graphics.release(this.all.get(e)),this.all.delete(e)}clear(e=()=>!0){for(let t of[...this.all.keys()])
e(t)&&this.remove(t)}trim(e,t,r){let{hasSteps:n=!1,hasMarks:s=!1,memory:o=0}=t??{};if(!e||!n)return;for(let h of s?Object.
keys(Me):[]){let u=[...this.all.keys()].filter(m=>m.startsWith(`${h}/`));for(let m of u.slice(0,-ko))r.includes(Y(m))||this.
remove(m)}let i=e.slices.trace?"flow":"slices",c=h=>[...this.all.keys()].filter(u=>u.startsWith(h)),l=r.flatMap(h=>ie(e,
h));for(let h of c(`${i}/`).slice(0,-Lo[i][+(o>0)])){let u=Y(h);if(l.includes(u))continue;for(let p of[i,"extra"])this.remove(
`${p}/${u}`);let m=o?c("scalars/"):[];for(let p of m)Ee(p,u,e)&&this.remove(p)}}};var it=class{controller=new AbortController;observers=new Set;timers=new Set;globalListeners=0;get isOver(){return this.
controller.signal.aborted}listen(e,t,r,n={}){(e===document||e===window)&&(this.globalListeners+=1);let{signal:s}=this.controller;
e.addEventListener(t,r,{...n,signal:s})}later(e,t){let r=setTimeout(()=>{this.timers.delete(r),e()},t);return this.timers.
add(r),r}cancel(e){e!==null&&(clearTimeout(e),this.timers.delete(e))}observe(e,t){e.observe(t),this.observers.add(e)}watch(e,t,r){
e.observe(t,r),this.observers.add(e)}stats(){let{globalListeners:e,observers:t,timers:r}=this;return{listeners:e,observers:t.
size,timers:r.size}}end(){this.controller.abort(),this.globalListeners=0;for(let e of this.observers)e.disconnect();this.
observers.clear();for(let e of this.timers)clearTimeout(e);this.timers.clear()}};function Dn(a,e,t){let{geometry:r,slices:n,constants:s}=a,o=e,i=me(a),c=2**(Math.floor(Math.log2(r.extent))-s.noiseDoublings),
l=t.eye[3],h=F(r.frame,E(t.eye,k(r.center,l))),u=vr(a,e),m=u?"ramp":o.kernel,p=i&&m==="ramp"?"hann":m;return{u_eye:[...E(
h,k(t.anchor,l)),l],u_between:t.between,u_slicesSize:[r.columns.size,r.rows.size],u_deepest:r.levels,u_lags:n.lags,u_lagCount:n.
lags.length,u_sides:o.two_sided||i||u?n.sides:1,u_unit:n.unit,u_rateLayer:n.count-1,u_cell:n.cell,u_samples:ct(a,e,t.still)?
2*o.samples-1:o.samples,u_spacing:o.spacing,u_grain:o.grain*t.density,u_kernel:s.kernels.indexOf(p),u_lod:o.lod,u_contrast:o.
contrast,u_strength:o.strength,u_even:wr(a,e),u_fade:i?0:o.fade,u_seed:o.seed,u_showLevel:o.show_level,u_fixed:o.fixed_grain,
...Oo(a,o,t),...Fo(a,t,c),...No(a,t,c),u_noiseFinest:c,u_texel:r.extent/o.resolution,u_apart:Mr(a,e)*t.density,u_bySpeed:e.
arrow_length==="speed",u_arrowSides:n.sides,u_pieces:s.arrows.pieces,...a.image?Io(a.image,o,t.density):{}}}function ct(a,e,t=!1){
let r=e.motion!=="off"&&!me(a);return!a.image&&(r||a.slices.steps>1&&!t)}function vr(a,e){return!a.image&&e.texture==="s\
treaklets"}function wr(a,e){return!!(e.lod&&!e.fixed_grain)&&!a.image&&!vr(a,e)}function Le(a,e){return Number(e.arrows)>
0&&!me(a)&&!a.image}function Mr({constants:a},{arrows:e}){return a.arrows.least*Math.max(Number(e),a.arrows.mostDense)}function lt(a,e,t){
let{geometry:r,slices:n,constants:s}=a,o=e,i=Math.hypot(...E(t.eye,r.center))-.5*r.extent,c=t.eye[3]?Math.max(i,0)/Math.
hypot(...E(t.eye,t.focus)):1,l=o.lod?t.pixel*c*o.grain*t.density:r.extent/o.resolution;return Math.floor(o.samples/2)*o.
spacing*l<s.farCells*n.critical}function Bn(a,e,t,r){let n={FLOWTEX_CELLS:t,FLOWTEX_MOVING:ct(a,e,r),FLOWTEX_SPARSE:vr(a,
e),FLOWTEX_REPEATED:!!a.ends};return Object.entries(n).flatMap(([s,o])=>o?[s]:[])}function Oo(a,e,t){let{geometry:r,constants:n}=a,
{times:s,pace:o}=a.slices,i=s.length>1,c=!i&&e.speed_in==="pixels",l=s[s.length-1]-s[0],h=l*o/r.extent,u=i?l/(Math.round(
h)||h):e.period,m=(i?t.time-s[0]:t.clock)/u%n.mostTurns,p=u*(i?o:e.speed),f=m%n.clockStep;return{u_clock:[m-f,f],u_travel:p*
(c?t.density:1),u_travelInPixels:c,u_travelBySpeed:i||e.motion==="speed",u_wave:n.wavePixels*t.density}}function Fo(a,e,t){
let{noiseDoublings:r,clearDoublings:n}=a.constants,{frame:s,center:o}=a.geometry,i=F(s,E(e.focus,o)),c=2**(r-n)-1,l=2**n,
h=i.map(p=>_(Math.round(p/t/l),-c,c)*l),u=h.map(p=>p/Math.SQRT2),m=u.map(p=>Math.floor(p/l)*l);return{u_noiseOrigin:h.map(
(p,f)=>p*t-e.anchor[f]),u_noiseOriginEven:h,u_noiseOriginOdd:m,u_noiseRestOdd:u.map((p,f)=>p-m[f])}}function No(a,e,t){let{
ends:r,geometry:n,constants:s}=a;if(!r)return{};let{frame:o,center:i}=n,c=F(o,[1,0,0]),[l,h]=r.map(b=>b-i[0]-A(c,e.anchor)),
u=2**s.clearDoublings,m=k(c,(r[1]-r[0])/t),p=k(m,Math.SQRT1_2),f=b=>b.map(g=>Math.floor(g/u)*u),d=b=>b.map(g=>g-Math.floor(
g/u)*u);return{u_ends:[c[0],c[1],l,h],u_turnEven:f(m),u_turnRestEven:d(m),u_turnOdd:f(p),u_turnRestOdd:d(p)}}function Io({
size:a,stepSize:e,repeat:t,deviations:r},n,s){let o=r?1:n.tiles,i=s*(r?n.grain:o);return{u_stepSize:e.map(c=>c*s),u_imageSize:a.
map(c=>c*i),u_imageRound:[Number(t[1]),Number(t[0])],u_tiles:o,...r?{u_noiseDeviations:r}:{}}}function Er(a,e){if(a.length<
2)return[0,0,0];let t=0;for(;t<a.length-2&&a[t+1]<=e;)t+=1;let r=(e-a[t])/(a[t+1]-a[t]);return[t,t+1,_(r,0,1)]}var Co=.5,Uo=6,Vo=60,Do=.5,ht=class{time=0;clock=0;playing=!1;pace=1;times=[0];lastFrame=0;hasHeader=!1;setHeader(e){let{
times:t}=e.slices;(!(t.length===this.times.length&&t.every((n,s)=>n===this.times[s]))||!this.hasHeader)&&(this.time=e.time,
this.clock=e.clock),this.hasHeader=!0,this.times=t}get varies(){return this.times.length>1}get span(){return[this.times[0],
this.times[this.times.length-1]]}get moment(){return Er(this.times,this.time)}timeOf([e,t,r]){return this.times[e]+r*(this.
times[t]-this.times[e])}seek(e){this.time=_(e,...this.span)}stepFrom(e){let{times:t,time:r}=this,n=t.findIndex(i=>e>0?i>
r:i>=r),s=t.length,o=n<0?s:n;return t[(e>0?o:o-1+s)%s]}start(){this.playing=!0,this.lastFrame=0}range(e){if(this.varies)
return{first:this.span[0],last:this.span[1],now:this.time};let t=Number(e.period);return{first:0,last:t,now:this.clock%t}}advance(e,t){
let r=this.lastFrame?Math.min((e-this.lastFrame)/1e3,Do)*this.pace:0;if(this.lastFrame=e,!this.varies)return this.clock+=
r,!0;let[n,s]=this.span,o=_(Co*(this.times.length-1),Uo,Vo),i=this.time+r*(s-n)/o,[c,l]=Er(this.times,Math.min(i,s));return t(
[c,l])?(this.time=i>s?n:i,!0):!1}};var Hn=()=>null,ut=class{};var B="",Gn=5,z=a=>a.join("/"),ce=a=>a.split("/").map(Number);function zn(a,e){let[t,r,n]=["samples","spacing","grain"].
map(o=>Number(e[o])),s=.5*t*r*n;return a.cellPixels*Math.max(1,2*s/(a.cellPixels*a.pathCells))}var mt=class{header;place;constructor(e,t){
this.header=e;let r=0,n=e.blocks.map(([s,o])=>(r+=s*o)-s*o);this.place=typeof t=="function"?t:(s,o,i)=>{let c=Gn*(n[s]+o*
e.blocks[s][1]+i);return t.subarray(c,c+Gn)}}blocksOf(e,[t,r,n]){let[s,o]=this.header.blocks[t];if(e===B)return[0,0,s,o];
let{tileBlocks:i}=this.header,c=[Math.min(i*(r+1),s),Math.min(i*(n+1),o)];return[i*r,i*n,...c]}children(e,[t,r,n]){let{blocks:s,
tileBlocks:o}=this.header,i=s[t-1].map(u=>Math.ceil(u/o)),[c,l]=e===B?[[0,0],i]:[[2*r,2*n],[r,n].map((u,m)=>Math.min(2*u+
2,i[m]))],h=[];for(let u=c[0];u<l[0];u+=1)for(let m=c[1];m<l[1];m+=1)h.push([t-1,u,m]);return h}finerPart([,e,t],r){let{
tileBlocks:n}=this.header,s=n/2,[,o,i]=r===B?[0,0,0]:ce(r);return[s*e-n*o,s*t-n*i,s]}choose(e){let t=new Map,{depth:r,finest:n}=this.
header,s=[B];for(let o of s){let i=o===B?[r,0,0]:ce(o),c={key:i,needed:!1,pixels:0,finer:[]},[l,h,u,m]=this.blocksOf(o,i),
p=this.header.blocks[i[0]][1],f=new Set;for(let d=l;d<u;d+=1)for(let b=h;b<m;b+=1){let g=this.place(i[0],d,b);if(!Sr(e,g)||
e.shownOn?.sees(g)===!1)continue;let y=Tr(e,g)*(e.shownOn?.scale(g)??1);i[0]>n&&y>e.cellPixels?f.add(d*p+b):c.needed=!0,
f.has(d*p+b)||(c.pixels=Math.max(c.pixels,y))}f.size&&(c.finer=this.children(o,i).filter(d=>{let[b,g,y]=this.finerPart(d,
B);return[...f].some(x=>{let[v,w]=[Math.floor(x/p)-b,x%p-g];return v>=0&&v<y&&w>=0&&w<y})}).map(z)),t.set(o,c),s.push(...c.
finer)}return t}};function Sr({planes:a},[e,t,r,n]){return a.every(s=>A(s,[e,t,r])+s[3]>=-n*O(s.slice(0,3)))}function Tr({
eye:a,halfHeight:e,pixels:t},[r,n,s,o,i]){let c=a?Math.max(O(E([r,n,s],a))-o,i):1;return i*.5*t/(e*c)}function Wn(a){return[
...a].filter(([t,{needed:r}])=>t!==B&&r).sort(([,t],[,r])=>r.pixels-t.pixels).map(([t])=>t)}function Ar(a,e){let t=new Map,
r=s=>{t.delete(s),a.get(s)?.finer.forEach(r)},n=s=>{let{needed:o=!1,finer:i=[]}=a.get(s)??{},c=i.filter(n);return s!==B&&
!o&&c.length===i.length?!0:s!==B&&!e(s)?(c.forEach(r),!1):(t.set(s,c),!0)};return n(B),t}function pt(a,e,t){let r=s=>Math.
min(s*2**e,t-1),n=Math.floor(a);return r(n)+(a-n)*(r(n+1)-r(n))}function $n(a,e,t){let r=2**e,n=Math.max(Math.min(Math.floor(
a/r),Math.ceil((t-1)/r)-1),0);return n+(a-n*r)/(Math.min((n+1)*r,t-1)-n*r)}var jn=1e4,Bo=20,Ho=4,Go=4,zo="The surface is shown coarse",Wo="A part of the surface is shown coarse",$o="A time step c\
annot be shown",Te=class{times=new Map;now;constructor(e=()=>performance.now()){this.now=e}add(e){this.times.set(e,this.
now())}has(e){return this.now()-(this.times.get(e)??-1/0)<jn}},ke=class{source;taker;running=new Map;jobs=[];failed=new Te;constructor(e,t){
this.source=e,this.taker=t}want(e){this.jobs=e;let t=new Set(e.map(String));for(let[r,n]of this.running)t.has(r)||(this.
running.delete(r),n.abort());this.next()}stop(){this.want([]),this.failed=new Te}next(){for(let e of this.jobs){if(this.
running.size>=(this.source()?.atOnce??Ho))return;!this.running.has(String(e))&&!this.failed.has(String(e))&&this.run(e)}}async run(e){
let{taker:t}=this,r=this.source();if(!r)return;let[n,s,o]=e,i=new AbortController,{signal:c}=i,l=h=>n?t.tiles?.has(z(n),
h)??!1:t.parts.has(h);this.running.set(String(e),i);try{let h=await r.load(n,s,c,l,o);if(!c.aborted)for(let u of h)t.setPart(
u)}catch(h){c.aborted||this.fail(e,h)}c.aborted||(this.running.delete(String(e)),this.failed.has(String(e))||(this.jobs=
this.jobs.filter(h=>String(h)!==String(e))),this.next())}fail(e,t){let[r,n]=e;this.failed.add(String(e)),setTimeout(()=>this.
next(),jn+Bo);let s=t.fault==="unreachable",o=r&&!s?z(r):void 0;this.taker.lack(Xn(r?Wo:$o,t),o,n)}};function Xn(a,e){let{
fault:t,message:r=String(e),detail:n=""}=e;return console.warn(r,n),t==="other"?r:`${a}: ${r}`}var ft=class{tiles;wholes;marks;given;formula=null;constructor(e,t){
this.given=e,this.tiles=new ke(()=>this.source,t),this.wholes=new ke(()=>this.source,t),this.marks=new ke(()=>this.source,
t)}get source(){return this.formula??this.given}get hasSteps(){return this.source?.hasSteps??!1}get hasMarks(){return this.
source?.hasMarks??!1}setHeader(e){this.stop(),this.formula=e.formula?new ut(e,e.formula):null}follow(e){return this.formula?.
follow(e)??!1}fit(){return this.formula?.fit()??!1}trajectory(e){return this.formula?.trajectory(e)??null}open(){let{taker:e}=this.
tiles;this.source?.open?.().catch(t=>e.lack(Xn(zo,t)))}wantTiles(e,t){this.tiles.want(e.map(r=>[r,t]))}wantSteps(e){let t=this.
wholes.jobs.flatMap(([,n])=>n);if(e.every(n=>t.includes(n)))return;let r=[...new Set([...e,...t])].slice(0,e.length+Go);
this.wholes.want(r.map(n=>[null,[n]]))}wantMarks(e){let t=e.map(([r,n])=>[null,[n],r]);String(t)!==String(this.marks.jobs)&&
this.marks.want(t)}stop(){this.tiles.stop(),this.wholes.stop(),this.marks.stop()}};function Yn({header:a,camera:e,anchor:t,player:r,rows:n},s,o){let{geometry:i,constants:c}=a,l=e.state.focal_point,h=F(i.
frame,E(l,i.center)),u=c.anchorRange*2*e.height,m=p=>p.some(f=>Math.abs(f)>u);return{focus:l,anchor:m(E(h,t))?m(h)?h:[0,
0,0]:t,eye:e.eye,between:s[2],time:r.timeOf(s),clock:r.clock,still:!r.playing,density:o,pixel:2*e.height/Math.max(n*o,1)}}var jo=-1e9,qn=500;function dt(a,e){if(a instanceof Float32Array&&!e.some(Boolean))return a;let t=new Float32Array(a.length);
for(let r=0;r<a.length;r+=1)t[r]=a[r]-e[r%3];return t}function Kn({shape:a,rows:e,columns:t}){return Float32Array.from({
length:2*a[0]*a[1]},(r,n)=>{let[s,{before:o,size:i}]=n%2?[Math.floor((n>>1)/a[1]),e]:[(n>>1)%a[1],t];return(s+o+.5)/i})}
function Jn(a,e){let t=Math.max(a.length,e.length);return Float32Array.from({length:2*t},(r,n)=>(n%2?e:a)[n>>1]??0)}function Zn(a){
let e=Float32Array.from(a);for(let t=0;t<a.length;t+=3){let r=Math.hypot(a[t],a[t+1],a[t+2])||1;for(let n=t;n<t+3;n+=1)e[n]/=
r}return e}function bt(a,e){let t=a[0]?.length??0,r=new Float32Array(2*t),n=pr(e);return a.forEach((s,o)=>{for(let i=0;i<
t;i+=1){let c=n(s[i]);r[2*i+o]=Number.isFinite(c)?_(c,-qn,qn):jo}}),r}function Qn([a,e],[t,r]){let[n,s]=[Math.min(Math.floor(
t),e-2),Math.min(Math.floor(r),a-2)],[o,i]=[t-n,r-s],c=s*e+n,[l,h]=[Math.min(o,i),Math.max(o,i)],u=c+(o>=i?1:e);return[[
c,1-h],[u,h-l],[c+e+1,l]]}function gt(a,e){return a.reduce((t,[r,n])=>t+n*e(r),0)}var Xo=1-1e-7;function es(a,e){return Uint32Array.
from({length:4*e.length},(t,r)=>r%4<3?a[3*(r>>2)+r%4]:e[r>>2])}function Oe(a,e,t){return[t,a+Math.min(Math.max(e,0),Xo)]}
function ts(a,[e,t]){let r=Math.floor(t),[n,s]=[t-r,e];return[1-n-s,n,s].map((o,i)=>[a[3*r+i],o])}var rs=180/Math.PI;var Yo=1e-4;function qo(a){let[e,t,r]=[a-1,a-2,a-3];return[-(e*t*r)/6,a*t*r/2,-(a*e*r)/2,a*e*t/6]}function ns(a,e){let t=a*(e-1),r=_(
Math.floor(t)-1,0,e-4);return[r,qo(t-r)]}function _r([a,e,t,r],{data:n,shape:s},o){let[i,c]=s,[l,h]=ns((o[0]-a)/(t-a),c),
[u,m]=ns((o[1]-e)/(r-e),i),p=[0,0,0];return m.forEach((f,d)=>{h.forEach((b,g)=>{for(let y=0;y<3;y+=1)p[y]+=b*f*n[3*((u+d)*
c+l+g)+y]})}),p}function yt(a,e,t){if(a.map&&!t)return null;let[r,n,s]=a.map&&t?_r(a.map,t,e):e,o=[Math.atan2(n,r),Math.
atan2(s,Math.hypot(r,n))];return o.every(Number.isFinite)?[o[0]*rs,o[1]*rs]:null}function ss(a,e,t,r){let[n,s]=[e,t];if(a.
map&&r){let{map:p,radius:f}=a,d=Yo*(p[2]-p[0])/(Math.hypot(...t)||1),[b,g]=[-d,d].map(y=>_r(p,r,e.map((x,v)=>x+y*t[v])));
n=_r(p,r,e),s=g.map((y,x)=>f*(y-b[x])/(2*d))}let[o,i,c]=n,[l,h]=[Math.hypot(o,i)||1,Math.hypot(o,i,c)||1],u=(o*s[1]-i*s[0])/
l,m=(o*s[0]+i*s[1])/l;return[u,(l*s[2]-c*m)/h]}var ls=2,as=8,Ko=4,Jo=10,hs=.05,Zo=.25,Qo=.75,os=4,ei=.01,us=1e-6,ti=.001;function ri({scene:a,place:e},[t,r]){let{rows:n,
columns:s,triangles:o}=a.header.geometry;if(o){let p=[-t-r,t,r];return a.cornersAt(e).map(([f,d],b)=>[f,d+p[b]])}let[i,c]=[
e[0]+t+s.before,e[1]+r+n.before],[l,h]=[Math.floor(i),Math.floor(c)],[u,m]=[i-l,c-h];return[(1-u)*(1-m),u*(1-m),(1-u)*m,
u*m].map((p,f)=>{let d=_(l+(f&1),0,s.size-1);return[_(h+(f>>1),0,n.size-1)*s.size+d,p]})}function Pr(a,e=[0,0]){let{scene:t,
moment:r}=a,{slices:n}=t.header,s=ri(a,e),[o,i,c]=r,l=s.map(([p])=>p),h=(o===i?[o]:[o,i]).map(p=>t.texels(p,l)),u=o===i?
[1]:[1-c,c],m=me(t.header)?ni(s.map((p,f)=>h[0](0,f))):s.map(()=>1);return p=>{let f=[0,0,0,0];return s.forEach(([,d],b)=>{
let g=p+(p>n.lags.length?-1:1)*n.lags.length,y=m[b]<0&&p>0?g:p;h.forEach((x,v)=>{u[v]&&x(y,b).forEach((w,M)=>{let P=p===
ls&&M===3?Math.max(w,0):w;f[M]+=d*u[v]*P*(M<3?m[b]:1)})})}),f}}function ni(a){let e=[0,0,0];return a.map(([t,r,n])=>{let s=A(
e,[t,r,n])<0?-1:1;return e=T(e,[t,r,n],s),s})}function si(a,e,t,r,n){let[s,o]=[a(0).slice(0,3),0],i=a(t+1)[3],c=Math.min(
i,e[e.length-1]),l=[];for(let h=0;h<e.length&&o<c;h+=1){let u=a(t+h+1).slice(0,3);for(let m=1;m<=as;m+=1){let p=m/as,f=Math.
min(o+p*(e[h]-o),c),d=(f-o)/(e[h]-o),b=s.map((g,y)=>g+d*(u[y]-g));if(l.push(k(b,r*f*n)),f===c)break}[s,o]=[u,e[h]]}return l}
function ms({scene:a,place:e,position:t}){let{image:r,geometry:n}=a.header;if(!r)return l=>T(t,K(n.frame,l));let{alongI:s,
alongJ:o}=r,i=[is(s,e[0]),is(o,e[1])],c=Fe(a,e);return([l,h])=>{let u=[cs(s,i[0]+l),cs(o,i[1]+h)];return u.some(Number.isNaN)?
null:T(t,E(Fe(a,u),c))}}function Ne(a,e){return T(Fe(a,e),a.header.geometry.center)}function Fe(a,e){let{data:t}=a.part(
"position"),r=a.cornersAt(e),n=[0,1,2].map(s=>gt(r,o=>t[3*o+s]));return K(a.header.geometry.frame,n)}function ps(a,e){let{
shape:t,triangles:r}=a.header.geometry;if(r){let i=(c,l)=>Fe(a,Oe(Math.floor(e[1]),c,l));return[E(i(1,0),i(0,0)),E(i(0,1),
i(0,0))]}let[n,s]=e.map((i,c)=>_(i,.5,t[1-c]-1.5)),o=(i,c)=>Fe(a,[n+i,s+c]);return[E(o(.5,0),o(-.5,0)),E(o(0,.5),o(0,-.5))]}function is(a,e){let t=Math.min(Math.floor(e),a.length-2);return a[t]+(e-t)*(a[t+1]-a[t])}function cs(a,e){let t=a.findIndex(
r=>r>=e);return t<0||e<a[0]?NaN:t===0?0:t-1+(e-a[t-1])/(a[t]-a[t-1])}function ai(a,e,t,r){let{scene:n,place:s,position:o}=a,
{geometry:i,image:c}=n.header,{height:l,ray:h}=t.at(o),u=2*l/r;if(c){let f=N(...ps(n,s)),d=Math.max(Math.abs(A(C(f),h)),
hs),[b,g]=[c.alongI,c.alongJ].map((v,w)=>{let M=Math.min(Math.floor(s[w]),v.length-2);return(v[M+1]-v[M])*c.stepSize[w]}),
y=Math.sqrt(O(f)/(b*g)),x=c.deviations?u*Number(e.grain):u;return e.lod?Math.max(x/Math.sqrt(d),y):y}let m=i.extent/Number(
e.resolution);if(!e.lod)return m;let p=u*fs(a,t).side*Number(e.grain);return e.fixed_grain?Math.max(p,m):p}function oi(a,e,t){
if(a.scene.header.image||!e.lod||e.fixed_grain)return 1;let{side:r,across:n,area:s}=fs(a,t);if(!n)return 1;let o=_(s/(n*
r),1/os,os);return Math.abs(o-1)<ei?1:o}function fs(a,e){let{geometry:t}=a.scene.header,r=C(N(...ps(a.scene,a.place))),n=C(
N(r,K(t.frame,Pr(a)(0).slice(0,3)))),{ray:s}=e.at(a.position),o=A(r,s),i=(o<0?-1:1)*Math.max(Math.abs(o),hs),[c,l]=e.axes.
slice(0,2).map(d=>T(d,s,-A(r,d)/i)),h=O(N(c,l)),u=.5*(A(c,c)+A(l,l)),m=Math.sqrt(u+Math.sqrt(Math.max(u**2-h**2,0))),p=Math.
sqrt(m*Math.max(h/m,Zo*m)),f=Math.hypot(A(c,n),A(l,n));return{side:Math.max(p,Qo*f),across:f,area:h}}function ii(a,e,t){
let r=[],[n,s]=[a,t];for(let o of e){let i=O(E(o,n));if(i>=s){s>0&&r.push(T(n,E(o,n),s/(i||1)));break}r.push(o),s-=i,n=o}
return r}function ds([a,e,t]){return a===e?[[[a,a,0],1]]:[[[a,a,0],1-t],[[e,e,0],t]]}function Rr(a){let e=[0,0,0];for(let[
t,r]of ds(a.moment))r&&(e=T(e,ci({...a,moment:t}),r));return e}function ci(a){let{scene:e,position:t}=a,{slices:r,image:n,
speed:s}=e.header,o=Pr(a),[i,c,l]=o(0),h=[i,c,l],u=k(h,ti*(n?1/n.stepSize[0]:r.cell)/(O(h)||1)),m=O(h)>us?E(ms(a)(u)??t,
t):h;return k(C(m),o(ls)[3]*s.typical)}function bs(a,e,t,r){let{scene:n,position:s}=a,{slices:o,image:i}=n.header,c=Pr(a),
l=!me(n.header),h=c(0),u=[h[0],h[1],h[2]],m=ms(a),p=[],f=e.two_sided||!l?o.sides:1;for(let M=0;M<f&&O(u)>us;M+=1){let P=i?
1:h[3]*o.unit,R=si(c,o.lags,M*o.lags.length,M?1:-1,P).map(m),L=R.findIndex(U=>U===null);p.push(R.slice(0,L<0?void 0:L))}
let d=Number(e.samples),b=ct(n.header,e,!0)?2*d-1:d,y=(f===2?Math.floor(b/2):b-1)*oi(a,e,t),x=Number(e.spacing)*ai(a,e,t,
r),v=M=>{let[P=[],S=[]]=p.map(R=>ii(s,R,M));return[...P.reverse(),s,...S]};return{path:v(Ko*Math.max(y,Jo)*x),sampled:v(
y*x),directed:l,velocity:Rr(a)}}var li=8,hi=1e-6,ui=.001,mi=89.99,pi=a=>a-360*Math.round(a/360);function Lr([a,e]){return[[a,e],[a+1,e],[a,e+1],[a+1,e+1]]}
function xt({header:a},e){return e.map((t,r)=>_(Math.floor(t),0,a.geometry.shape[1-r]-2))}var gs=([a,e])=>[(1-a)*(1-e),a*
(1-e),(1-a)*e,a*e];function ys(a,e,[t,r],n){let{earth:s}=a.header,o=Lr(e).map(d=>s&&yt(s,Ne(a,d),n));if(o.some(d=>!d||Math.
abs(d[1])>mi))return null;let[i,c,l,h]=o.map(d=>[pi(d[0]-t),d[1]-r]),[u,m]=[c,l].map(d=>[d[0]-i[0],d[1]-i[1]]),p=Math.max(
...[...u,...m].map(Math.abs)),f=u[0]*m[1]-u[1]*m[0];return!f||[0,1].some(d=>Math.abs(i[d]-c[d]-l[d]+h[d])>ui*p)?null:[(i[1]*
m[0]-i[0]*m[1])/f,(i[0]*u[1]-i[1]*u[0])/f]}function xs(a,e,t,r){let{earth:n,geometry:s}=a.header,o=n&&!s.triangles&&yt(n,
t,r);if(!o)return e;let i=xt(a,e);for(let c=0;c<li;c+=1){let l=ys(a,i,o,r);if(!l)return e;let h=l.map(m=>Math.abs(m-.5)>
.5+hi?m:0),u=xt(a,i.map((m,p)=>m+h[p]));if(String(u)===String(i))return i.map((m,p)=>m+_(l[p],0,1));i=u}return e}function vs(a,e){
let{earth:t,geometry:r}=a.header;if(!t||r.triangles)return a.cornersAt(e);let n=xt(a,e),s=gs(e.map((o,i)=>o-n[i]));return Lr(
n).map(([o,i],c)=>[i*r.shape[1]+o,s[c]])}function ws(a,e){let{scene:t,place:r,position:n}=a,{earth:s,geometry:o}=t.header,
i=s&&yt(s,n,e);if(!i)return null;let c=m=>ss(s,m.position,Rr(m),e),l=xt(t,r);if(o.triangles||!ys(t,l,i,e))return c(a);let h=gs(
r.map((m,p)=>m-l[p])),u=Lr(l).map(m=>c({...a,place:m,position:Ne(t,m)}));return[0,1].map(m=>u.reduce((p,f,d)=>p+h[d]*f[m],
0))}var fi=16;function Es(a,e,t,r,[n,s]){let{layer:o,coordinate:i,triangle:c}=a,{geometry:l}=o.scene.header,h=l.triangles?Oe(
c,...i):di(l,...i),u=t.ray(n,s),m=Ms(o.scene,h,u)[1],[p,f]=Ms(o.scene,m,u),d=xs(o.scene,f,p,e.parts.get("lonlat")),b=l.triangles?
d:bi(e.header,o,d);return{point:{position:p,index:b,values:gi(o.scene,r,d)},layer:o,place:d}}function di({rows:a,columns:e,
shape:t},r,n){let s=(o,{size:i,before:c},l)=>_(o*i-.5-c,0,l-1);return[s(r,e,t[1]),s(n,a,t[0])]}function bi(a,{key:e},[t,
r]){let{pyramid:n,geometry:s,mesh:o,formula:i}=a,[c,l,h]=e,[u,m]=n?.shapes[0]??s.shape,p=o.tileCells*(n?.tileBlocks??0),
f=i?2**(n?.depth??0):1,d=(b,g,y)=>pt(b+g*p,c,y)/f;return[d(t,h,m),d(r,l,u)]}function Ms(a,e,[t,r]){let{geometry:n}=a.header,
{data:s}=a.part("position"),o=a.cornersAt(e).map(([v])=>v),[i,c,l]=o.map(v=>T(K(n.frame,[...s.subarray(3*v,3*v+3)]),n.center)),
[h,u]=[E(c,i),E(l,i)],m=N(h,u),p=T(t,r,A(m,E(i,t))/A(m,r)),f=E(p,i),[d,b]=[N(f,u),N(h,f)].map(v=>A(v,m)/A(m,m));if(!(Math.
max(Math.abs(d),Math.abs(b))<fi)){let v=Ne(a,e);return[T(t,r,A(E(v,t),r)/A(r,r)),e]}if(n.triangles)return[p,Oe(Math.floor(
e[1]),d,Math.max(b,0))];let[g,y]=n.shape,x=(v,w)=>{let[M,P,S]=o.map(v);return _(M+d*(P-M)+b*(S-M),0,w-1)};return[p,[x(v=>v%
y,y),x(v=>Math.floor(v/y),g)]]}function gi(a,e,t){let{header:r,parts:n}=a,{scalars:s,geometry:o}=r,i=vs(a,t),c=o.triangles?
Math.floor(t[1]):i[0][0],[l,h,u]=e,m={},p=s.choices.map((f,d)=>({...f,number:d}));for(let f of[s,...p]){let d=a.scalarParts(
l,h,f),[b,g]=d.map(x=>n.get(x)?.data);if(f.name===null||f.name in m||!b||!g)continue;let y=x=>b[x]+u*(g[x]-b[x]);m[f.name]=
f.flat?y(c):gt(i,y)}return m}function Ss({sigma:a,radii:e},t,[r,n,s,o]){let i=a*t,c=2**Math.max(Math.floor(Math.log2(Math.SQRT2*i)),0),l=c>1?c**2/6+1/
12:0,h=i**2-l,[u,m]=[r,n].map(b=>Math.floor(b/c)*c),[p,f]=[s-u,o-m].map(b=>Math.ceil(b/c)+2),d=e*Math.sqrt(h);return{side:c,
first:[u,m],end:[s,o],columns:p,rows:f,variance:h,reach:d}}var vt=class{graphics;targets=[];columns=0;rows=0;constructor(e){
this.graphics=e}draw(e,t,r){let{graphics:n}=this,s=n.context,{side:o,first:i,end:c,columns:l,rows:h,variance:u,reach:m}=t,
[p,f]=[c[0]-i[0],c[1]-i[1]];this.fit(l,Math.max(f,h)),s.bindVertexArray(null);for(let y of[s.SCISSOR_TEST,s.DEPTH_TEST,s.
BLEND])s.disable(y);let[d,b]=this.targets,g={u_side:o,u_variance:u,u_reach:m};n.programs.use(e,{...g,u_from:i,u_along:[1,
0],u_count:p}),this.pass(d,l,f,r),n.programs.use(e,{u_from:[0,0],u_along:[0,1],u_count:f}),this.pass(b,l,h,d.texture),this.
bind("u_means",b.texture)}dispose(){for(let{frame:e,texture:t}of this.targets)this.graphics.free("Framebuffer",e),this.graphics.
free("Texture",t);this.targets=[],this.columns=this.rows=0}pass({frame:e},t,r,n){let s=this.graphics.context;this.bind("\
u_source",n),s.bindFramebuffer(s.FRAMEBUFFER,e),s.viewport(0,0,t,r),s.drawArrays(s.TRIANGLES,0,3)}bind(e,t){let r=this.graphics.
context;r.activeTexture(r.TEXTURE0+Q.indexOf(e)),r.bindTexture(r.TEXTURE_2D,t),r.activeTexture(r.TEXTURE0+Q.length)}fit(e,t){
if(this.columns>=e&&this.rows>=t)return;let[r,n]=[Math.max(e,this.columns),Math.max(t,this.rows)];this.dispose();let{graphics:s}=this,
o=s.context;this.targets=[0,1].map(()=>{let i=s.counted(o.createTexture());o.bindTexture(o.TEXTURE_2D,i),o.texStorage2D(
o.TEXTURE_2D,1,o.R16F,r,n),o.texParameteri(o.TEXTURE_2D,o.TEXTURE_MIN_FILTER,o.NEAREST),o.texParameteri(o.TEXTURE_2D,o.TEXTURE_MAG_FILTER,
o.NEAREST);let c=s.counted(o.createFramebuffer());return o.bindFramebuffer(o.FRAMEBUFFER,c),o.framebufferTexture2D(o.FRAMEBUFFER,
o.COLOR_ATTACHMENT0,o.TEXTURE_2D,i,0),{frame:c,texture:i}}),[this.columns,this.rows]=[r,n]}};var yi=3,Ts=5;function As({shape:a,triangles:e},t,r,n){let[s,o]=t.shape,i=new Int8Array(s*o).fill(e?0:Math.log2(n));for(let c=0;c<
r.length;c+=3){if(Number.isFinite(r[c]))continue;let[l,h]=[Math.floor(c/3/a[1]),c/3%a[1]];for(let u of[Math.floor((l-1)/
n),Math.floor(l/n)])for(let m of[Math.floor((h-1)/n),Math.floor(h/n)])u>=0&&u<s&&m>=0&&m<o&&(i[u*o+m]=0)}return i}function _s({
shape:a,data:e},t,r,n,s){let[o,i]=a,c={...t.sight(r),planes:t.planes},l=new Int8Array(o*i).fill(-1),h=[1,1,-1,-1];for(let u=0;u<
l.length;u+=1){let[m,p]=[Math.floor(u/i),u%i],f=e.subarray(Ts*u,Ts*(u+1));if(n.some(([g,y,x])=>m>=g&&m<g+x&&p>=y&&p<y+x)||
!Sr(c,f))continue;let b=Math.floor(Math.log2(yi/Tr(c,f)));l[u]=Math.min(Math.max(b,0),s[u]),xi(t,f).forEach((g,y)=>h[y]=
y<2?Math.min(h[y],g):Math.max(h[y],g))}return{levels:l,box:h}}function xi(a,[e,t,r,n]){let[s,o,i]=a.axes,{parallel:c,position:l,
focal_point:h}=a.state,u=E([e,t,r],c?h:l),m=[-n,n].map(d=>a.at(T([e,t,r],i,d)).height);if(!(m[0]>0))return[-1,-1,1,1];let[
p,f]=[-n,n].map(d=>[A(u,s)/a.aspect,A(u,o)].map((b,g)=>m.map(y=>(b+d/(g?1:a.aspect))/y)));return[...p.map(d=>Math.min(...d)),
...f.map(d=>Math.max(...d))]}var vi=1024,Ps=["u_places","u_depths","u_colours","u_strides","u_below","u_texture"].map(a=>Q.indexOf(a)),wt=class{width=0;height=0;graphics;means;target=null;key="";layers=[];seen=[];squares=0;constructor(e){
this.graphics=e,this.means=new vt(e)}draw({layers:e,camera:t,anchor:r,width:n,height:s}){let o=e.map(({scene:p,covered:f})=>[
p.number,p.version,f]),i=JSON.stringify([o,t.state,t.aspect,r,n,s]);if(i===this.key)return;Object.assign(this,{key:i,layers:e,
width:n,height:s});let c=this.graphics.context,{frames:l}=this.make(n,s),[{scene:h}]=e,u=Math.min(...e.map(({key:[p]})=>p))+
Math.log2(h.header.mesh.tileCells);this.seen=e.map(({scene:p,covered:f,key:[d]})=>{let b=p.doublings.map(g=>Math.max(Math.
min(g,u-d),0));return _s(p.blocks,t,s,f,b)}),this.sendStrides(),c.bindFramebuffer(c.FRAMEBUFFER,l[0]),c.viewport(0,0,n,s),
c.disable(c.SCISSOR_TEST),c.enable(c.DEPTH_TEST),c.depthFunc(c.LESS),c.disable(c.BLEND),c.clearBufferuiv(c.COLOR,0,[0,0,
0,0]),c.clear(c.DEPTH_BUFFER_BIT);let m=G(h.header.geometry,t,r);h.bodies.hide(m,r),h.bodies.seeThrough(()=>this.triangles(
h.programs("place"),m,r),!1)}triangles(e,t,r,n={}){let{graphics:s,layers:o,seen:i}=this,c=s.context,{mesh:l,pyramid:h,geometry:u}=o[0].
scene.header,[m,p]=h?.shapes[0]??u.shape;this.bind(),c.bindVertexArray(null),o.forEach(({scene:f,key:[d,...b]},g)=>{let{
levels:y}=i[g],{columns:x,rows:v,shape:w,triangles:M}=f.header.geometry,[P,S]=b.map(L=>L*l.tileCells*(h?.tileBlocks??0)*
2**d);f.bindNodes(r),s.programs.use(e,{...n,u_matrix:t,u_layer:g+1,u_blocks:y.reduce((L,U,I)=>L|(U<0?0:1<<I),0),u_part:[
S,P,d],u_lastNode:[p-1,m-1,this.squares],u_closed:[Number(u.periodic[1]),Number(u.periodic[0])],u_blockCells:l.tileCells,
u_slicesSize:[x.size,v.size],u_padding:[x.before,v.before]}),M&&c.drawArrays(c.TRIANGLES,0,f.part("triangles").data.length);
let R=f.blocks.shape[1];y.forEach((L,U)=>{if(L<0||M)return;let I=[U%R,Math.floor(U/R)].map(V=>V*l.tileCells),[J,ae]=I.map(
(V,Z)=>Math.ceil(Math.min(l.tileCells,w[1-Z]-1-V)/2**L));s.programs.use(e,{u_block:[...I,L,J]}),c.drawArrays(c.TRIANGLES,
0,6*J*ae)})})}sum(e,t,r,n){let{graphics:s,width:o,height:i,target:c}=this,l=s.context,h=i-t-r;l.bindFramebuffer(l.FRAMEBUFFER,
c?.frames[1]??null),l.enable(l.SCISSOR_TEST),l.scissor(0,h,o,r),l.clearBufferfv(l.COLOR,1,[0,0,0,0]),this.pixels(e,h,r,n),
l.readPixels(0,0,1,1,l.RGBA,l.UNSIGNED_BYTE,new Uint8Array(4)),l.bindFramebuffer(l.FRAMEBUFFER,null)}colour(e,t){let{graphics:r,
layers:n,means:s,height:o,target:i}=this,c=r.context,[{scene:l}]=n;this.bind();let h=e===null?null:Ss(l.header.constants.
even,e,this.box);h&&s.draw(l.programs("blur"),h,i?.textures[5]??null),c.bindFramebuffer(c.FRAMEBUFFER,i?.frames[2]??null);
let u={u_first:h?.first??[0,0],u_side:h?.side??1};this.pixels(l.programs("colour"),0,o,m=>({...t(m),...u})),c.bindFramebuffer(
c.FRAMEBUFFER,null)}boxOf({box:e}){let{width:t,height:r}=this,[n,s,o,i]=e.map((l,h)=>(.5+.5*l)*(h%2?r:t));return[...[n,s].
map(l=>Math.max(Math.floor(l),0)),Math.min(Math.ceil(o),t),Math.min(Math.ceil(i),r)]}get box(){let e=this.seen.map(t=>this.
boxOf(t)).filter(([t,r,n,s])=>t<n&&r<s);return e.length?[0,1,2,3].map(t=>{let r=e.map(n=>n[t]);return t<2?Math.min(...r):
Math.max(...r)}):[0,0,1,1]}pixels(e,t,r,n){let{graphics:s,width:o,height:i}=this,c=s.context;c.viewport(0,0,o,i),c.enable(
c.SCISSOR_TEST),c.disable(c.DEPTH_TEST),c.disable(c.BLEND),c.bindVertexArray(null),this.layers.forEach(({scene:l},h)=>{let[
u,m,p,f]=this.boxOf(this.seen[h]),[d,b]=[u,Math.max(m,t)],[g,y]=[p-d,Math.min(f,t+r)-b];if(g<=0||y<=0)return;c.scissor(d,
b,g,y);let x=n(l);this.bind(),s.programs.use(e,{...x,u_layer:h+1}),c.drawArrays(c.TRIANGLES,0,3)})}show(e){let t=this.graphics.
context;this.bind(),t.bindVertexArray(null),this.graphics.programs.use(e,{u_bottom:0}),t.drawArrays(t.TRIANGLES,0,3)}at(e,t){
let{graphics:r,target:n,layers:s}=this,o=r.context,[i,c]=[(.5+.5*e)*this.width,(.5+.5*t)*this.height],l=_(Math.floor(i-.5),
0,this.width-2),h=_(Math.floor(c-.5),0,this.height-2),u=new Uint32Array(16);o.bindFramebuffer(o.FRAMEBUFFER,n?.frames[0]??
null),o.readPixels(l,h,2,2,o.RGBA_INTEGER,o.UNSIGNED_INT,u),o.bindFramebuffer(o.FRAMEBUFFER,null);let m=+(i>=l+1)+2*+(c>=
h+1),p=4*([m,m^1,m^2,m^3].find(b=>u[4*b+3])??m),[f,d]=new Float32Array(u.buffer,4*p,2);return u[p+3]?{layer:s[u[p+3]-1],
coordinate:[f,d],triangle:u[p+2]}:null}dispose(){let{graphics:e,target:t}=this;for(let r of t?.textures??[])e.free("Text\
ure",r);for(let r of t?.frames??[])e.free("Framebuffer",r);this.means.dispose(),this.target=null,this.key=""}sendStrides(){
let{layers:e,seen:t,target:r}=this,n=this.graphics.context,[{scene:s}]=e,{pyramid:o,geometry:i}=s.header,c=i.triangles?[
1,1]:o?.blocks[0]??s.blocks.shape;this.squares=Math.max(Math.ceil(Math.log2(Math.max(...c)/vi)),0);let l=2**-this.squares,
[h,u]=c.map(p=>Math.ceil(p*l)),m=new Uint8Array(h*u);e.forEach(({scene:p,key:[f,...d]},b)=>{let g=p.blocks.shape[1],y=2**
f*l;t[b].levels.forEach((x,v)=>{if(x<0||i.triangles)return;let[[w,M],[P,S]]=[Math.floor(v/g),v%g].map((R,L)=>{let U=(R+d[L]*
(o?.tileBlocks??0))*y;return[Math.floor(U),Math.min(Math.ceil(U+y),[h,u][L])]});for(let R=w;R<M;R+=1)for(let L=P+R*u;L<S+
R*u;L+=1)m[L]=Math.max(m[L],f+x)})}),n.activeTexture(n.TEXTURE0+Ps[3]),n.bindTexture(n.TEXTURE_2D,r?.textures[3]??null),
n.pixelStorei(n.UNPACK_ALIGNMENT,1),n.texImage2D(n.TEXTURE_2D,0,n.R8UI,u,h,0,n.RED_INTEGER,n.UNSIGNED_BYTE,m)}make(e,t){
let{target:r,graphics:n}=this;if(r&&r.width>=e&&r.height>=t)return r;let s=n.context,{key:o}=this,i={width:Math.max(e,r?.
width??0),height:Math.max(t,r?.height??0)};this.dispose();let c=[s.RGBA32UI,s.DEPTH_COMPONENT24,s.RGBA8,0,s.RGBA8,s.RGBA16F].
map(g=>{let y=n.counted(s.createTexture());return s.bindTexture(s.TEXTURE_2D,y),g&&s.texStorage2D(s.TEXTURE_2D,1,g,i.width,
i.height),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MIN_FILTER,s.NEAREST),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MAG_FILTER,
s.NEAREST),y}),[l,h]=[s.COLOR_ATTACHMENT0,s.COLOR_ATTACHMENT1],[u,m,p,,f,d]=c,b=[[[l,u],[s.DEPTH_ATTACHMENT,m]],[[l,f],[
h,d]],[[l,p]]].map(g=>{let y=n.counted(s.createFramebuffer());s.bindFramebuffer(s.FRAMEBUFFER,y);for(let[x,v]of g)s.framebufferTexture2D(
s.FRAMEBUFFER,x,s.TEXTURE_2D,v,0);return s.drawBuffers(g.map(([x])=>x).filter(x=>x!==s.DEPTH_ATTACHMENT)),y});return this.
key=o,this.target={frames:b,textures:c,...i}}bind(){let e=this.graphics.context;Ps.forEach((t,r)=>{e.activeTexture(e.TEXTURE0+
t),e.bindTexture(e.TEXTURE_2D,this.target?.textures[r]??null)}),e.activeTexture(e.TEXTURE0+Q.length)}};function Rs(a,e){var t=e[0],r=e[1],n=e[2],s=e[3],o=e[4],i=e[5],c=t*s-r*n;return c?(c=1/c,a[0]=s*c,a[1]=-r*c,a[2]=-n*c,a[3]=
t*c,a[4]=(n*i-s*o)*c,a[5]=(r*o-t*i)*c,a):null}function Ls(a){return a[0]*a[3]-a[1]*a[2]}function ks(a,e,t){var r=e[0],n=e[1],
s=e[2],o=e[3],i=e[4],c=e[5],l=t[0],h=t[1],u=t[2],m=t[3],p=t[4],f=t[5];return a[0]=r*l+s*h,a[1]=n*l+o*h,a[2]=r*u+s*m,a[3]=
n*u+o*m,a[4]=r*p+s*f+i,a[5]=n*p+o*f+c,a}var Mi=14,Ei=40,Si=256;function Os(a,e){a?.clearRect(0,0,e.width,e.height),a?.drawImage(e,0,0)}var Ti=(a,e)=>a.getContext(
"2d",{alpha:e}),Mt=class{viewer;content;graphics;canvas;pen;last=document.createElement("canvas");lastPen;lastCamera=null;coarse=document.
createElement("canvas");coarsePen;front=document.createElement("canvas");frontPen=this.front.getContext("2d");frontLook="";version=1;draftVersion=0;rowsDone=0;layers=[];isRefined=!1;fixed=4;isCoarse=!1;constructor(e,t){
this.viewer=e,this.content=t,this.graphics=e.graphics,this.canvas=e.canvas;let{canvas:r,last:n,coarse:s}=this,o=[r,n,s].
map(i=>Ti(i,e.isClear??!1));[this.pen,this.lastPen,this.coarsePen]=o}restart(e=!1){e||(this.lastCamera=null),this.version+=
1,this.rowsDone=0}refine(){(this.rowsDone>=this.canvas.height||!this.content.isComing)&&(this.rowsDone=0),this.isRefined=
!0}resize(e,t){let{canvas:r,coarse:n,last:s}=this;n.width=r.width,n.height=r.height,this.coarsePen?.drawImage(r,0,0),r.width=
s.width=e,r.height=s.height=t,n.width>1&&this.pen?.drawImage(n,0,0,e,t)}dispose(){for(let e of[this.last,this.coarse,this.
front])e.width=e.height=0}draw(e,t,r){let n=this.isMoving;if(this.draftVersion!==this.version)return this.draft(e,t,n);if(n)
return!1;let s=!1;do s=this.strip(e,t)&&!this.isRefined;while(!s&&performance.now()<r);return s}get isMoving(){return this.
viewer.player.playing||this.viewer.isHeld}get leavesOut(){return this.isCoarse&&this.isMoving}arrange(e){this.isRefined=
!1,this.layers=this.content.arrange(e)}draft(e,t,r){let{width:n,height:s}=this.canvas,o=Number(this.viewer.settings.samples),
i=r?this.graphics.waiting.size+1:1;this.arrange(t);let c=e.price*this.factor(o),l=this.viewer.player.playing&&!this.viewer.
isHeld,h=Pn(c,this.fixed,n*s,o,l),u=Math.max(h/i,Mi),m=_n(c,this.fixed,n*s,o,u),p=Math.max(Math.round(n*m.scale),1),f=Math.
max(Math.round(s*m.scale),1);this.draftVersion=this.version;let d=m.scale<1?this.reuse():null;if(!d?.covers){let g=performance.
now();this.place(t,p,f);let y=this.sum(e,t,0,f,m.samples);this.show(t,!1,m.samples),this.fixed+=.5*(_(performance.now()-
g-y,.5,500)-this.fixed)}d&&this.pen&&(this.pen.imageSmoothingEnabled=!d.shifts,this.pen.setTransform(...d.matrix),Os(this.
pen,this.last),this.pen.setTransform(1,0,0,1,0,0)),this.isCoarse=m.scale<1||m.samples<o;let b=!this.isCoarse&&!this.content.
smooth;return b&&this.complete(),this.drawLines(t),b&&!this.isRefined}strip(e,t){let{width:r,height:n}=this.canvas,s=Number(
this.viewer.settings.samples);if(this.rowsDone>=n&&(this.rowsDone=0),this.rowsDone===0&&(this.arrange(t),this.isRefined))
return!1;this.place(t,r,n);let o=e.price*this.factor(s),i=Math.min(n-this.rowsDone,Rn(Ei,o,r,s));return this.sum(e,t,this.
rowsDone,i,s),this.rowsDone+=i,this.rowsDone<n?!1:(this.show(t,this.content.smooth,s),this.complete(),this.drawLines(t),
!0)}drawLines(e){let{front:t,frontPen:r,graphics:n}=this,{camera:s,ratio:o}=this.viewer,{scene:i}=this.content,{width:c,
height:l}=this.canvas;if(!i||!s||!r)return;let{earth:h,bodies:u}=i;if(!h.lines.length&&!u.labels.length)return;let{state:m,
aspect:p}=s,f=JSON.stringify([m,p,c,l,h.lines,h.version]);if(f!==this.frontLook){let{anchor:d}=this.viewer.view(e,o),{canvas:b}=n;
b.width<c&&(b.width=c),b.height<l&&(b.height=l),t.width=c,t.height=l,h.drawLines({camera:s,anchor:d,width:c,height:l,ratio:o},
()=>{let g=b.height-l;r.drawImage(b,0,g,c,l,0,0,c,l)}),u.drawLabels(r,{camera:s,anchor:d,width:c,height:l,ratio:o}),this.
frontLook=f}this.pen?.drawImage(t,0,0)}complete(){let{camera:e,player:t}=this.viewer;this.rowsDone=this.canvas.height,this.
isCoarse=!1,this.draftVersion=this.version,Os(this.lastPen,this.canvas),e&&!t.playing&&(this.lastCamera=new de(e.state,e.
limits,e.flat,e.aspect))}reuse(){let{lastCamera:e}=this,{camera:t}=this.viewer,{scene:r}=this.content;if(!r?.header.geometry.
planar||!t||!e||!t.state.parallel||!e.state.parallel)return null;let{geometry:n}=r.header,s=E(t.state.focal_point,n.center),
o=F(n.frame,s),[i,c]=[e,t].map(l=>G(n,l,o));return Pi(i,c,this.canvas.width,this.canvas.height)}factor(e){let{settings:t,
player:r}=this.viewer;return t.motion!=="off"||r.varies&&r.playing?Ln(e):1}placeAt(e,t,r){let{places:n}=this.content;return this.
place(e,n?.width||this.canvas.width,n?.height||this.canvas.height),n?.at(t,r)??null}place(e,t,r){let{viewer:n,layers:s,content:o}=this,
{camera:i}=n;if(!i||!s.length)return;let{anchor:c}=n.view(e,this.density(r));o.places?.draw({layers:s,camera:i,anchor:c,
width:t,height:r})}density(e){return this.viewer.ratio*e/this.canvas.height}sum(e,t,r,n,s){let{places:o,scene:i}=this.content,
{camera:c}=this.viewer;if(!o||!i||!c)return 0;let{width:l,height:h}=o,u=this.viewer.view(t,this.density(h)),m=this.isDraft(
h,s),p=b=>(b.bindNodes(u.anchor),b.bindTextures(t[0],t[1]),{...this.values(b,i,c,u,s,m),...Mn(b.header.geometry,c,u.anchor,
l,h)});e.warm||o.sum(e,r,1,p),e.warm=!0;let f=performance.now();o.sum(e,r,n,p);let d=performance.now()-f;return e.price=
kn(e.price,d,l*n,s,this.factor(s)),d}isDraft(e,t){return t!==this.viewer.settings.samples||e!==this.canvas.height}colour(e,t,r){
let{scene:n}=this.content,{camera:s}=this.viewer;if(!n||!s)return;let{height:o}=e,i=this.viewer.view(t,this.density(o)),
c=this.isDraft(o,r),l=u=>this.values(u,n,s,i,r,c),h=wr(n.header,this.viewer.settings)?Number(l(n).u_grain):null;e.colour(
h,l)}show(e,t,r){let{places:n}=this.content;if(!n)return;this.colour(n,e,r);let{width:s,height:o}=n,{canvas:i}=this.graphics;
i.width<s&&(i.width=s),i.height<o&&(i.height=o);let c=t?Si:o;for(let l=0;l<o;l+=c)this.render(e,l,Math.min(c,o-l),t)}render(e,t,r,n){
let{graphics:s,viewer:o}=this,{camera:i}=o,{scene:c,places:l}=this.content;if(!i||!c||!l)return;let h=s.context,{width:u,
height:m}=l,p=o.view(e,this.density(m));n?s.bindSmooth(u,r):h.bindFramebuffer(h.FRAMEBUFFER,null),h.viewport(0,-t,u,m),h.
enable(h.SCISSOR_TEST),h.scissor(0,0,u,r),h.enable(h.DEPTH_TEST),h.depthFunc(h.LESS),h.disable(h.BLEND),h.disable(h.CULL_FACE);
let[f,d,b]=c.header.background??[1,1,1];h.clearColor(f,d,b,o.isClear?0:1),h.clear(h.COLOR_BUFFER_BIT|h.DEPTH_BUFFER_BIT);
let g={camera:i,anchor:p.anchor,width:u,height:m,ratio:o.ratio};c.earth.drawGround(g);let{bodies:y}=c;y.draw(g,"opaque"),
y.seeThrough(()=>{if(!n)return l.show(c.programs("surface"));let x=G(c.header.geometry,i,p.anchor);l.triangles(c.programs(
"smooth"),x,p.anchor,{u_bottom:t})}),this.drawArrows(e,p,u,m),y.draw(g,"clear"),c.marks.draw({...g,ratio:p.density},o.settings,
e),n&&s.copySmooth(u,r),this.copy(u,m,t,r)}drawArrows(e,t,r,n){let{camera:s,settings:o}=this.viewer,{scene:i}=this.content;
if(!i||!s||!Le(i.header,o))return;let c={...s.sight(n/t.density),planes:s.planes},l=n!==this.canvas.height,h=this.layers.
map(u=>u.scene);for(let[u,m]of i.arrows.share(c,o,h)){let{arrows:p,header:f}=u,d=p.program(o,lt(f,o,t));if(!d||!m.length)
continue;u.bindTextures(e[0],e[1]);let b=u.scalarParts(e[0],e[1]),g=this.values(u,i,s,t,Number(o.samples),l);p.draw(d,m,
b,t.anchor,{...g,u_picture:[r,n]})}}values({header:e},{bodies:t},r,n,s,o){let{settings:i}=this.viewer,{columns:c,rows:l}=e.
geometry,h=e.scalars.name!==null&&Le(e,i)&&i.arrow_color==="scalars";return{...Dn(e,{...i,samples:s},n),...o?On(i,s,n.density):
{},u_matrix:G(e.geometry,r,n.anchor),u_mapped:e.scalars.name!==null&&!h,u_plain:h,u_flat:!!e.scalars.flat,u_padding:[c.before,
l.before],u_colour:e.colour,u_lit:e.lighting,u_ground:e.background??[1,1,1],u_opacity:t.areBehind?1:e.opacity,u_toEye:F(
e.geometry.frame,k(r.axes[2],-1))}}copy(e,t,r,n){let{pen:s}=this;if(!s)return;let{canvas:o}=this.graphics,i=o.height-n,[
c,l]=[this.canvas.width,this.canvas.height/t];if(s.imageSmoothingEnabled=c!==e||l!==1,s.imageSmoothingEnabled){let{coarse:u,
coarsePen:m}=this;u.width=e,u.height=n,m?.drawImage(o,0,i,e,n,0,0,e,n),[o,i]=[u,0]}let h=(t-r-n)*l;s.clearRect(0,h,c,n*l),
s.drawImage(o,0,i,e,n,0,h,c,n*l)}},Ai=4,_i=.3,kr=1e-6,Fs=(a,e)=>ks([0,0,0,0,0,0],a,e),Ns=a=>Rs([0,0,0,0,0,0],a);function Pi(a,e,t,r){
let[n,s]=[t/2,r/2],o=M=>Fs([n,0,0,-s,n,s],[M[0],M[1],M[4],M[5],M[12],M[13]]),i=Fs(o(e),Ns(o(a))),c=Math.abs(Ls(i));if(!(c>
_i**2&&c<Ai**2))return null;let[l,h,u,m,p,f]=Ns(i),d=([M,P])=>Math.abs((l*M+u*P+p)/n-1)<1+kr&&Math.abs((h*M+m*P+f)/s-1)<
1+kr,b=[[0,0],[t,0],[0,r],[t,r]].every(d),[g,y,x,v]=i,w=Math.abs(g-1)+Math.abs(v-1)+Math.abs(y)+Math.abs(x)<kr;if(w)for(let M of[
4,5])i[M]=Math.round(i[M]);return{matrix:i,covers:b,shifts:w}}var At=4,_t=class{surface;limits;sums;whole=[[]];last=null;constructor(e,t){this.surface=e,this.limits=t;let r=0;this.sums=
Float64Array.from({length:e.corners.length/At},(n,s)=>r+=this.area(Or(s)))}seen(e,t){return(!this.last||!this.covers(this.
last.wanted,[e,t]))&&(this.last={wanted:[e,t],seeds:this.make([e,t])}),this.last.seeds}position(e,t){let{nodes:r,corners:n}=this.
surface;return Ie(r,n.subarray(At*e,At*(e+1)),t,3)}point(e){let{frame:t,center:r}=this.surface.geometry;return T(K(t,e),
r)}covers([e,t],[r,n]){let{closer:s}=this.limits;return this.cornersOf(r).every(o=>s*t*Tt(e,o)<=n*Tt(r,o)&&this.sees(e,o,
0))}cornersOf({planes:e}){let{center:t,extent:r}=this.surface.geometry,n=c=>e[c].slice(0,3),s=N(n(0),n(2)),o=.5*r*O(s);return[
0,1].flatMap(c=>[2,3].flatMap(l=>[-1,1].map(h=>[c,l,h]))).map(([c,l,h])=>{let[u,m]=[n(c),n(l)],p=T(k(N(m,s),-e[c][3]),N(
s,u),-e[l][3]),f=N(u,m);return k(T(p,f,A(s,t)+h*o),1/A(f,s))})}sees(e,t,r){let n=r+this.limits.around*e.pixels*Tt(e,t);return e.
planes.every(s=>A(s,t)+s[3]>=-n*O(s))}make(e){let[t,r]=e,{limits:n,sums:s,whole:o}=this,{extent:i,center:c}=this.surface.
geometry,l=s[s.length-1]??0,h=t.eye?Math.max(O(E(c,t.eye))-.5*i,0):1,u=n.closer*r*Fr(t,h),m=i,p=o[0],f=null;for(let d=0;d<
n.mostOctaves;d+=1){let b=n.candidateArea*m**2;if(l<=n.mostCandidates*b)o[d+1]??=this.grown(p,this.spread(d,b),m),p=o[d+
1];else{f??=Array.from(s,(y,x)=>Or(x)),f=this.divided(f.filter(y=>this.isNeeded(y,e,m)),b);let g=f.flatMap(y=>{let x=le(
y.key+d);return St(x)*b<this.area(y)?[this.candidate(y,x)]:[]});if(p=this.grown(p,g,m),!f.length)break}if(m<=u)break;m*=
n.octave}return p.filter(d=>{let b=this.point(d.position);return d.radius>=n.closer*r*Tt(t,b)&&this.sees(t,b,0)})}spread(e,t){
let{sums:r}=this,n=le(e+Et),s=0;return Array.from({length:Math.floor((r[r.length-1]??0)/t)},(o,i)=>{let c=le(n+i),l=(i+St(
c))*t;for(;s<r.length-1&&r[s]<=l;)s+=1;return this.candidate(Or(s),c)})}candidate({cell:e,low:t,size:r},n){let s=le(n+Et),
o=le(s+Et),i=[t[0]+r[0]*St(s),t[1]+r[1]*St(o)];return{cell:e,place:i,position:this.position(e,i),radius:1/0}}grown(e,t,r){
let n=r/this.limits.octave,s=new Pt(n);for(let l of e)s.add(l.position);for(let l of t)l.radius=s.distance(l.position);let o=t.
filter(({radius:l})=>l>=r).sort((l,h)=>h.radius-l.radius),i=new Pt(n),c=o.filter(l=>(l.radius=Math.min(l.radius,i.distance(
l.position)),l.radius<r?!1:(i.add(l.position),!0)));return[...e,...c]}isNeeded(e,[t,r],n){let{octave:s,closer:o,aroundRadii:i}=this.
limits,{cell:c,low:l,size:h}=e,u=this.point(this.position(c,[l[0]+.5*h[0],l[1]+.5*h[1]])),[m,p]=this.sides(e),f=.5*(O(m)+
O(p)),d=Math.max(Us(t,u)-f,0);return!(n<s*o*r*Fr(t,d))&&this.sees(t,u,f+i*n)}divided(e,t){let r=e.filter(o=>this.area(o)>
t);if(!r.length)return e;let n=r.map(o=>{let[i,c]=this.sides(o),l=O(c)>O(i)?1:0,h=[...o.size];h[l]*=.5;let u=[...o.low];
return u[l]+=h[l],[{...o,size:h,key:le(o.key+Et)},{...o,size:h,low:u,key:le(o.key+Ri)}]}),s=e.filter(o=>this.area(o)<=t);
return this.divided([...s,...n.map(([o])=>o),...n.map(([,o])=>o)],t)}sides({cell:e,low:t,size:r}){let n=(s,o)=>this.position(
e,[t[0]+r[0]*s,t[1]+r[1]*o]);return[E(n(1,.5),n(0,.5)),E(n(.5,1),n(.5,0))]}area(e){return O(N(...this.sides(e)))}};function Ie(a,e,[
t,r],n){let s=[(1-r)*(1-t),(1-r)*t,r*(1-t),r*t],o=new Array(n).fill(0);for(let i=0;i<At;i+=1)for(let c=0;c<n;c+=1)o[c]+=
s[i]*a[n*e[i]+c];return o}var Pt=class{most;cubes=new Map;constructor(e){this.most=e}cube(e){return e.map(t=>Math.floor(
t/this.most))}add(e){let t=Cs(...this.cube(e)),r=this.cubes.get(t);r?r.push(e):this.cubes.set(t,[e])}distance(e){let[t,r,
n]=this.cube(e),s=this.most;for(let o=0;o<27;o+=1){let i=Cs(t+o%3-1,r+Math.floor(o/3)%3-1,n+Math.floor(o/9)-1);for(let c of this.
cubes.get(i)??[])s=Math.min(s,O(E(e,c)))}return s}},Et=2654435769,Ri=2246822507,Li=[739982445,695872825],Is=15;function Cs(a,e,t){
return Math.imul(a,2376512323)^Math.imul(e,3625334849)^Math.imul(t,3407524639)}function le(a){let e=a>>>0;for(let t of Li)
e=Math.imul(e^e>>>Is,t)>>>0;return(e^e>>>Is)>>>0}var St=a=>a/2**32;function Or(a){return{cell:a,low:[0,0],size:[1,1],key:le(
a)}}var Us=({eye:a},e)=>a?O(E(e,a)):1,Fr=({halfHeight:a,pixels:e},t)=>2*a/e*t,Tt=(a,e)=>Fr(a,Us(a,e));var Bs=[[0,3],[1,2],[2,3],[3,2],[4,3],[5,1]],Vs=4,ki=Bs.reduce((a,[,e])=>a+e,0),Oi=(a,e)=>a.length===e.length&&a.every((t,r)=>t===
e[r]),Ds=({tile:a})=>a?.[0]??1/0,Rt=class{graphics;header;parts;seeds=null;array=null;buffer=null;known=null;last=null;drawn=null;constructor(e,t,r){
this.graphics=e,this.header=t,this.parts=r}program(e,t){let{shaders:r,geometry:n}=this.header;if(!Le(this.header,e))return null;
let s=t&&!n.triangles?["FLOWTEX_CELLS"]:[];return this.graphics.programs.get(r.arrowVertex,r.arrowFragment,...s)}share(e,t,r){
let{header:n,last:s}=this;this.seeds??=new _t(this.surface,n.constants.arrows);let o=this.seeds.seen(e,Mr(n,t));if(s?.seeds===
o&&Oi(r,s.layers))return s.shared;let{corners:i}=this.surface,c=o.map(({cell:u,place:m,radius:p})=>{let f=i.subarray(4*u,
4*u+4);return{corners:f,place:m,radius:p,cell:n.geometry.triangles?u:f[0]}}),l=new Map(r.map(u=>[u,[]])),h=[...r].sort((u,m)=>Ds(
u)-Ds(m));for(let u of c)for(let m of h){let p=m.tile?this.inTile(u,m,m.tile):u;if(p){l.get(m)?.push(p);break}}return this.
last={seeds:o,layers:r,shared:l},l}draw(e,t,r,n,s){let{graphics:o}=this,i=o.context;this.array??=this.make(),i.bindVertexArray(
this.array);let{name:c,low:l,high:h,log:u}=this.header.scalars,m=r.map(f=>this.parts.get(f)?.digest),p=JSON.stringify([n,
r,m,c,l,h,u]);(this.drawn?.placed!==t||this.drawn.key!==p)&&(i.bindBuffer(i.ARRAY_BUFFER,this.buffer),i.bufferData(i.ARRAY_BUFFER,
this.numbers(t,r,n),i.DYNAMIC_DRAW),this.drawn={placed:t,key:p}),o.programs.use(e,s),i.enable(i.BLEND),i.blendFuncSeparate(
i.SRC_ALPHA,i.ONE_MINUS_SRC_ALPHA,i.ZERO,i.ONE),i.depthMask(!1),i.drawArraysInstanced(i.TRIANGLE_STRIP,0,2*(this.header.
constants.arrows.pieces+1),t.length),i.depthMask(!0),i.disable(i.BLEND),i.bindVertexArray(null)}forget(){this.known=this.
seeds=this.last=this.drawn=null}dispose(){this.graphics.free("Buffer",this.buffer),this.graphics.free("VertexArray",this.
array),this.array=this.buffer=null,this.forget()}inTile({corners:e,place:t,radius:r},n,[s,o,i]){let{geometry:c,pyramid:l,
mesh:h}=this.header;if(!l||c.triangles)return null;let u=h.tileCells*l.tileBlocks,[m,p]=n.header.geometry.shape,f=c.shape[1],
d=(x,v,w,M)=>{let P=l.shapes[0][v],S=$n(pt(x,l.depth,P),s,P)-w*u,R=Math.min(Math.max(Math.floor(S),0),M-1);return S<0||S>
M?null:[R,S-R]},b=d(e[0]%f+t[0],1,i,p-1),g=d(Math.floor(e[0]/f)+t[1],0,o,m-1);if(!b||!g||n.parts.get("cells")?.data[g[0]*
(p-1)+b[0]]===0)return null;let y=g[0]*p+b[0];return{corners:[y,y+1,y+p,y+p+1],place:[b[1],g[1]],radius:r,cell:y}}make(){
let e=this.graphics.context,t=this.graphics.counted(e.createVertexArray());this.buffer=this.graphics.counted(e.createBuffer()),
e.bindVertexArray(t),e.bindBuffer(e.ARRAY_BUFFER,this.buffer);let r=0;for(let[n,s]of Bs)e.enableVertexAttribArray(n),e.vertexAttribPointer(
n,s,e.FLOAT,!1,ki*Vs,r),e.vertexAttribDivisor(n,1),r+=s*Vs;return t}numbers(e,t,r){let{geometry:n,scalars:s}=this.header,
o=t.map(h=>this.parts.get(h)?.data??new Float32Array),i=bt(o,s),c=this.nodes,l=n.triangles?null:Kn(n);return Float32Array.
from(e.flatMap(({corners:h,place:u,radius:m,cell:p})=>{let[f,d]=u,[b,g,y,x]=Array.from(h,w=>[...c.subarray(3*w,3*w+3)]),
v=N(E(T(g,x),T(b,y)),E(T(y,x),T(b,g)));return[...E(Ie(c,h,u,3),r),...l?Ie(l,h,u,2):[f*(1-d),d],...C(v),...s.flat?i.subarray(
2*p,2*p+2):Ie(i,h,u,2),...Array.from(h).slice(0,3),m]}))}get nodes(){return this.parts.get("position")?.data??new Float32Array}get surface(){
return this.known??={geometry:this.header.geometry,nodes:this.nodes,corners:this.corners()}}corners(){let{geometry:e}=this.
header,[t,r]=e.shape,n=[];if(e.triangles){let o=this.parts.get("triangles")?.data??[];for(let i=0;i<o.length;i+=3)n.push(
o[i],o[i+1],o[i+2],o[i+2]);return Uint32Array.from(n)}let s=this.parts.get("cells")?.data;for(let o=0;o<(t-1)*(r-1);o+=1){
if(s&&!s[o])continue;let i=o+Math.floor(o/(r-1));n.push(i,i+1,i+r,i+r+1)}return Uint32Array.from(n)}};var Ce=["bodyPoints","bodyNormals","bodyColours","bodyFaces","bodyPieces"],Hs=8,[Fi,Ni]=[24,8],Ae=[1,2],Ii=.2;function Ue(a,e,t){
let r=a.constructor,n=new r(t*e.length);for(let s=0;s<e.length;s+=1)for(let o=0;o<t;o+=1)n[t*s+o]=a[t*e[s]+o];return n}function Ci({
geometry:a,bodies:e},t){let[r,n,s]=t.axes,o=(e?.lights??[]).slice(0,Hs),i=o.map(({way:l,turns:h})=>{let u=T(T(k(r,l[0]),
n,l[1]),s,-l[2]);return F(a.frame,h?u:l)}),c=l=>Float32Array.from({length:3*Hs},(h,u)=>l.flat()[u]??0);return{u_lightWays:c(
i),u_lightColours:c(o.map(({color:l})=>l))}}var Lt=class{graphics;header;parts;drawn=null;constructor(e,t,r){this.graphics=
e,this.header=t,this.parts=r}get labels(){return this.header.bodies?.labels??[]}get runs(){let{bodies:e}=this.header;return e&&
Ce.every(t=>this.parts.has(t))?e.runs:[]}get areBehind(){return this.runs.length>0&&this.header.opacity<1}get programs(){
let{programs:e}=this.graphics,{bodyVertex:t,bodyFragment:r,lineVertex:n,lineFragment:s}=this.header.shaders;return[e.get(
t,r),e.get(n,s,"FLOWTEX_BODY"),e.get(t,r,"FLOWTEX_HIDING")]}get isReady(){return!this.runs.length||this.programs.every(({
ready:e})=>e)}dispose(){let{drawn:e,graphics:t}=this;if(e){for(let r of e.buffers)t.free("Buffer",r);t.free("VertexArray",
e.faces),t.free("VertexArray",e.pieces),this.drawn=null}}seeThrough(e,t=this.areBehind){if(!this.runs.length)return e();
let r=this.graphics.context;r.enable(r.POLYGON_OFFSET_FILL),r.polygonOffset(Ae[0],Ae[0]),t&&(r.enable(r.BLEND),r.blendColor(
0,0,0,this.header.opacity),r.blendFuncSeparate(r.CONSTANT_ALPHA,r.ONE_MINUS_CONSTANT_ALPHA,r.ZERO,r.ONE)),e(),r.disable(
r.BLEND),r.disable(r.POLYGON_OFFSET_FILL)}draw({camera:e,anchor:t,width:r,height:n,ratio:s},o){let i=o==="clear",c=this.
runs.filter(({clear:P})=>P===i);if(!c.length)return;let{header:l,graphics:h}=this,{geometry:u}=l,m=h.context,[p,f]=this.
programs,d=this.drawn??=this.make(),b=G(u,e,t),[g,y,x,v]=e.eye,w=F(u.frame,E([g,y,x],k(u.center,v)));i&&(m.enable(m.BLEND),
m.blendFuncSeparate(m.SRC_ALPHA,m.ONE_MINUS_SRC_ALPHA,m.ZERO,m.ONE),m.depthMask(!1)),h.programs.use(p,{u_matrix:b,u_anchor:t,
u_eye:[...E(w,k(t,v)),v],...Ci(l,e)}),m.bindVertexArray(d.faces),m.enable(m.POLYGON_OFFSET_FILL),m.polygonOffset(Ae[1],Ae[1]);
for(let{faces:[P,S],ambient:R,diffuse:L}of c)S&&(h.programs.use(p,{u_ambient:R,u_diffuse:L}),m.drawElements(m.TRIANGLES,
3*S,m.UNSIGNED_INT,12*P));m.disable(m.POLYGON_OFFSET_FILL);let M={u_matrix:b,u_anchor:t,u_picture:[r,n],u_horizon:[0,0,0,
1]};h.programs.use(f,M),m.bindVertexArray(d.pieces);for(let{pieces:[P,S],width:R}of c)if(S){h.programs.use(f,{u_width:R*
s});for(let[L,U,I,J,ae]of[[d.ends,3,m.FLOAT,Fi,0],[d.colours,4,m.UNSIGNED_BYTE,Ni,2]]){m.bindBuffer(m.ARRAY_BUFFER,L);for(let V of[
0,1])m.vertexAttribPointer(ae+V,U,I,U===4,J,J*(P+V/2))}m.drawArraysInstanced(m.TRIANGLE_STRIP,0,4,S)}m.bindVertexArray(null),
m.depthMask(!0),m.disable(m.BLEND)}hide(e,t){let{runs:r,graphics:n}=this;if(!r.length)return;let s=n.context,o=this.drawn??=
this.make();s.enable(s.POLYGON_OFFSET_FILL),s.polygonOffset(Ae[1],Ae[1]),n.programs.use(this.programs[2],{u_matrix:e,u_anchor:t}),
s.bindVertexArray(o.faces);for(let{faces:[i,c],clear:l}of r)l||s.drawElements(s.TRIANGLES,3*c,s.UNSIGNED_INT,12*i);s.disable(
s.POLYGON_OFFSET_FILL),s.bindVertexArray(null)}drawLabels(e,{camera:t,anchor:r,width:n,height:s,ratio:o}){let{geometry:i}=this.
header,c=G(i,t,r);for(let{text:l,position:h,size:u,color:m,plate:p}of this.labels){let f=E(F(i.frame,E(h,i.center)),r),[
d,b,,g]=[0,1,2,3].map(S=>c[S]*f[0]+c[4+S]*f[1]+c[8+S]*f[2]+c[12+S]);if(g<=0)continue;let[y,x]=[(.5+.5*d/g)*n,(.5-.5*b/g)*
s],v=u*o,w=Ii*v;e.font=`600 ${v}px system-ui, sans-serif`,e.textBaseline="middle";let[M,P]=[e.measureText(l).width+2*w,v+
2*w];e.fillStyle=Gs(p),e.beginPath(),e.roundRect(y,x-P,M,P,w),e.fill(),e.fillStyle=Gs(m),e.fillText(l,y+w,x-.5*P)}}make(){
let{graphics:e,parts:t}=this,r=e.context,[n,s,o,i,c]=Ce.map(g=>t.get(g)?.data??[]),l=()=>{let g=e.counted(r.createVertexArray());
return r.bindVertexArray(g),g},h=(g,y=r.ARRAY_BUFFER)=>{let x=e.counted(r.createBuffer());return r.bindBuffer(y,x),r.bufferData(
y,g,r.STATIC_DRAW),x},u=l(),p=[[n,3,r.FLOAT],[s,3,r.BYTE],[o,4,r.UNSIGNED_BYTE]].map(([g,y,x],v)=>{let w=h(g);return r.enableVertexAttribArray(
v),r.vertexAttribPointer(v,y,x,x!==r.FLOAT,0,0),w});p.push(h(i,r.ELEMENT_ARRAY_BUFFER));let f=l(),d=h(Ue(n,c,3)),b=h(Ue(
o,c,4));for(let g=0;g<4;g+=1)r.enableVertexAttribArray(g),r.vertexAttribDivisor(g,1);return r.bindVertexArray(null),{faces:u,
pieces:f,ends:d,colours:b,buffers:[...p,d,b]}}};function Gs([a,e,t,r=1]){return`rgb(${[a,e,t].map(n=>Math.round(255*n)).
join(" ")} / ${r})`}var kt=["land","missing"];var Ui=.18;function zs({background:a,earth:e}){let t=a??[1,1,1],r=e?.missingShare??0,n=A(t.map(s=>s**2.2),[.2126,.7152,.0722])>=
Ui?0:1;return t.map(s=>s*(1-r)+n*r)}var Ys=1e30,Ws=65535,$s=256;function Vi(a,{low:e,size:t}){let r=[],n=[0,0,0];for(let s=0;s<a.length;s+=4){a[s+3]&&r.push(
[]);let o=n.map((i,c)=>(n[c]=n[c]+a[s+c]&Ws,e[c]+n[c]/Ws*t[c]));r[r.length-1].push(o)}return r}function Di(a,e){return e?
a.flatMap(t=>{let r=0,n=t.filter((s,o)=>{let i=r;return o&&(r+=Math.hypot(...s.map((l,h)=>l-t[o-1][h]))),Math.floor(r/e)>
Math.floor(i/e)||o===0||o===t.length-1});return r<e?[]:[n]}):a}function Bi(a,e){let t=a.reduce((s,o)=>s+o.length+1,0),r=new Float32Array(
3*t).fill(Ys),n=0;for(let s of a){n+=3;for(let o of s)for(let i=0;i<3;i+=1)r[n++]=o[i]-e[i]}return r}function Hi(a){let e=[],
t=a.length/3-1;for(let r=0;r<t;r+=$s){let n=Math.min($s,t-r),[s,o]=[[1/0,1/0,1/0],[-1/0,-1/0,-1/0]];for(let l=3*r;l<3*(r+
n+1);l+=1)a[l]!==Math.fround(Ys)&&(s[l%3]=Math.min(s[l%3],a[l]),o[l%3]=Math.max(o[l%3],a[l]));let i=s.map((l,h)=>(l+o[h])/
2),c=Math.hypot(...s.map((l,h)=>(o[h]-l)/2));e.push({first:r,count:n,middle:i,radius:c})}return e}function Gi(a,e){let t=[];
for(let{first:r,count:n,middle:[s,o,i],radius:c}of a){let l=([u,m,p,f])=>u*s+m*o+p*i+f<-c*Math.hypot(u,m,p);if(e.some(l))
continue;let h=t[t.length-1];h&&h[0]+h[1]===r?h[1]+=n:t.push([r,n])}return t}var js=12,Xs=2;var Ot=class{version=0;graphics;header;parts;drawn=new Map;constructor(e,t,r){this.graphics=e,this.header=t,this.parts=r}forget(e){
this.version+=1;for(let t of e==="position"?kt:[e])this.drop(t)}dispose(){for(let e of[...this.drawn.keys()])this.drop(e)}drop(e){
let t=this.drawn.get(e);if(t){for(let r of t.buffers)this.graphics.free("Buffer",r);this.graphics.free("VertexArray",t.array),
this.drawn.delete(e)}}get lines(){let{earth:e}=this.header;return e?en.filter(t=>e[t]&&this.parts.has(t)):[]}drawLines(e,t){
let{header:r,graphics:n}=this,{earth:s,shaders:o}=r,i=n.programs.get(o.lineVertex,o.lineFragment);if(!s||!i.ready)return;
let c=n.context,{camera:l,anchor:h,width:u,height:m,ratio:p}=e;c.bindFramebuffer(c.FRAMEBUFFER,null),c.viewport(0,0,u,m),
c.enable(c.SCISSOR_TEST),c.scissor(0,0,u,m),c.disable(c.DEPTH_TEST),c.enable(c.BLEND),c.blendEquation(c.MAX),c.clearColor(
0,0,0,0);let f=this.horizon(l),b=[...l.planes,...f?[f]:[]].map(w=>this.localPlane(w,h)),g=2*l.height*p/m,y=_(Math.sqrt(m/
p/s.usualHeight),...s.widthRange),x=s.spacingPixels*g,v=s.spacings.find(w=>w<=x)??0;for(let{option:w,color:M,opacity:P,width:S}of s.
strokes){if(!this.lines.includes(w))continue;c.clear(c.COLOR_BUFFER_BIT);let R=this.take(w,h,()=>this.linesOf(w,h,v),v);
n.programs.use(i,{u_matrix:G(r.geometry,l,h),u_picture:[u,m],u_width:S*y*p,u_lineColour:[...M,P],u_horizon:f?b[b.length-
1]:[0,0,0,1]}),c.bindVertexArray(R.array),c.bindBuffer(c.ARRAY_BUFFER,R.buffers[0]);for(let[L,U]of Gi(R.groups,b)){for(let I=0;I<
Xs;I+=1)c.vertexAttribPointer(I,3,c.FLOAT,!1,js,(L+I)*js);c.drawArraysInstanced(c.TRIANGLE_STRIP,0,4,U)}t()}c.bindVertexArray(
null),c.blendEquation(c.FUNC_ADD),c.disable(c.BLEND)}get isReady(){let{lineVertex:e,lineFragment:t}=this.header.shaders,
{earth:r}=this.header;return r?.land&&(r.map===null&&r.below&&!this.groundProgram("FLOWTEX_GLOBE").ready||this.hasCells&&
!this.groundProgram(...this.roundness).ready)?!1:!this.lines.length||this.graphics.programs.get(e,t).ready}groundProgram(...e){
let{groundVertex:t,groundFragment:r}=this.header.shaders;return this.graphics.programs.get(t,r,...e)}get hasCells(){return kt.
some(e=>this.parts.has(e))}get roundness(){return this.header.earth?.map===null?["FLOWTEX_ROUND"]:[]}drawGround({camera:e,
anchor:t}){let{header:r,graphics:n}=this,{earth:s,geometry:o}=r;if(!s?.land)return;let i=s.map===null,c=kt.filter(p=>this.
parts.has(p)),l=n.context,h={u_matrix:G(o,e,t),u_ground:r.background??[1,1,1],u_lit:r.lighting,u_toEye:F(o.frame,k(e.axes[2],
-1))},u=zs(r);if(i&&s.below){let p=this.groundProgram("FLOWTEX_GLOBE");if(!p.ready)return;n.programs.use(p,{...h,u_colour:u,
...this.disc(e,s.radius,t)}),l.bindVertexArray(this.take("disc",t,()=>this.emptyArray()).array),l.drawArrays(l.TRIANGLE_STRIP,
0,4)}let m=this.groundProgram(...this.roundness);if(!c.length||!m.ready)return l.bindVertexArray(null);l.depthMask(!1);for(let p of c){
let f=p==="land"?s.land:u,d=E(F(o.frame,k(o.center,-1)),t);n.programs.use(m,{...h,u_colour:f,...i&&{u_middle:d}});let b=this.
take(p,t,()=>this.cellsOf(p,t));l.bindVertexArray(b.array),l.drawElements(l.TRIANGLES,b.count,l.UNSIGNED_INT,0)}l.depthMask(
!0),l.bindVertexArray(null)}horizon(e){let{earth:t}=this.header;if(!t||t.map)return null;let{radius:r}=t,[n,s,o,i]=e.eye,
c=i*Math.hypot(n,s,o);return[...C([n,s,o]),c?-(r**2)/c:0]}localPlane(e,t){let{frame:r,center:n}=this.header.geometry,s=e.
slice(0,3),o=F(r,s);return[...o,A(o,t)+A(s,n)+e[3]]}disc(e,t,r){let{frame:n,center:s}=this.header.geometry,[o,i,c,l]=this.
horizon(e)??[0,0,1,0],h=[o,i,c],u=Math.sqrt(Math.max(t**2-l**2,0)),m=C(N(e.axes[1],h)),p=N(h,m),f=T(k(h,-l),s,-1);return{
u_middle:E(F(n,f),r),u_aside:k(F(n,m),u),u_upward:k(F(n,p),u),u_away:e.state.parallel?0:O(e.state.position)/t}}take(e,t,r,n=0){
let s=this.drawn.get(e);if(s&&String([s.anchor,s.spacing])===String([t,n]))return s;this.drop(e);let o={...r(),anchor:t,
spacing:n};return this.drawn.set(e,o),o}emptyArray(){let{graphics:e}=this;return{array:e.counted(e.context.createVertexArray()),
buffers:[],anchor:[0,0,0],spacing:0,count:0,groups:[]}}buffer(e,t){let{graphics:r}=this,n=r.context,s=r.counted(n.createBuffer());
return n.bindBuffer(e,s),n.bufferData(e,t,n.STATIC_DRAW),s}linesOf(e,t,r){let n=this.graphics.context,{earth:s}=this.header,
o=this.parts.get(e)?.data??[],i=s?Vi(o,s):[],c=Bi(Di(i,r),t),l={...this.emptyArray(),groups:Hi(c)};n.bindVertexArray(l.array),
l.buffers=[this.buffer(n.ARRAY_BUFFER,c)];for(let h=0;h<Xs;h+=1)n.enableVertexAttribArray(h),n.vertexAttribDivisor(h,1);
return l}cellsOf(e,t){let r=this.graphics.context,n=this.parts.get(e),s=this.parts.get("position"),o=this.emptyArray();if(!n||
!s)return o;let i=this.header.geometry.triangles?n.data:zi(n);r.bindVertexArray(o.array);let c=dt(s.data,t);return o.buffers=
[this.buffer(r.ARRAY_BUFFER,c),this.buffer(r.ELEMENT_ARRAY_BUFFER,i)],o.count=i.length,r.enableVertexAttribArray(0),r.vertexAttribPointer(
0,3,r.FLOAT,!1,0,0),o}};function zi({data:a,shape:[e,t]}){let r=[];for(let n=0;n<e*t;n+=1){if(!a[n])continue;let s=n+Math.
floor(n/t),o=s+t+1;r.push(s,s+1,o+1,s,o+1,o)}return Uint32Array.from(r)}var[Wi,$i]=[.01,.2],[ne,qs]=[4,24],Ks=9;function Js(a,e,t){let r={lines:{"from saddle":[],"to saddle":[],"stable orbit":[],
"unstable orbit":[]},points:[]};for(let s=0;s<Math.min(a.length/ne,t.points);s+=1){let o=a[ne*s+3];(r.points[o]??=[]).push(
...[0,1,2].map(i=>a[ne*s+i]))}let n=NaN;for(let s=0;s<e.length/ne;s+=1){let o=e[ne*s+3];if(o>=et.saddle*t.saddles)continue;
let i=o&et.orbit?["stable orbit","unstable orbit"]:["from saddle","to saddle"],c=r.lines[i[o&et.leaving?0:1]];o!==n&&c.push(
[]),n=o,c[c.length-1].push(...[0,1,2].map(l=>e[ne*s+l]))}return r}function ji(a,e){let t=[];for(let r=0;r<a.length;r+=ne)
a[r+3]===e&&t.push(a[r],a[r+1],a[r+2]);return Float32Array.from(t)}function Ve(a,e=!1){let t=Float32Array.from(a.flat());
if(e)return Ue(t,Array.from({length:2*t.length/3},(s,o)=>o>>1),3);let r=[],n=0;for(let s of a){let o=s.length/3;for(let i=n;i<
n+o-1;i+=1)r.push(i,i+1);n+=o}return Ue(t,r,3)}var Ft=class{graphics;header;parts;array=null;buffer=null;drawn=null;constructor(e,t,r){
this.graphics=e,this.header=t,this.parts=r}kinds(e){let t=this.header.structure?.parts??[];return Object.keys(Me).filter(
r=>t.includes(r)&&Number(e[Me[r]])>0)}lacking(e,t){let r=Nr(t);return this.kinds(e).flatMap(n=>this.parts.has(`${n}/${r}`)?
[]:[[n,r]])}get program(){let{lineVertex:e,lineFragment:t}=this.header.shaders;return this.graphics.programs.get(e,t,"FL\
OWTEX_BODY","FLOWTEX_MARK")}isReady(e){return!this.kinds(e).length||this.program.ready}shown(e,t,r){let s=this.kinds(e).
includes(r)?this.parts.get(`${r}/${Nr(t)}`):void 0;return[s?Number(e[Me[r]]):0,s]}legend(e,t){let[r,n]=this.shown(e,t,"c\
ritical"),s=new Set;for(let m=0;m<Math.min(r,n?.shape[0]??0);m+=1)s.add(Number(n?.data[ne*m+3]));let{kinds:o=[],lines:i={},
nullclines:c=[]}=this.header.structure??{},[l,h]=this.shown(e,t,"separatrices"),u=Object.entries(Js([],h?.data??[],{points:0,
saddles:l}).lines).filter(([,m])=>m.length).map(([m])=>({name:m,color:i[m]}));return this.shown(e,t,"nullclines")[0]&&u.
push(...c),[...o.filter((m,p)=>s.has(p)),...u.map(m=>({...m,isLine:!0}))]}draw({camera:e,anchor:t,width:r,height:n,ratio:s},o,i){
let{header:c,graphics:l}=this,{structure:h,geometry:u}=c,m=h&&this.layers(h,o,i);if(!h||!m?.length)return;let p=l.context,
[f,d,b,g]=e.eye,y=F(u.frame,E([f,d,b],k(u.center,g))),x=s*_(Math.sqrt(n/s/h.usualHeight),...h.widthRange),v=g?1:e.distance/
Math.hypot(...y);p.bindVertexArray(this.array),p.enable(p.BLEND),p.blendFuncSeparate(p.SRC_ALPHA,p.ONE_MINUS_SRC_ALPHA,p.
ZERO,p.ONE),p.depthFunc(p.LEQUAL);let w=this.program;l.programs.use(w,{u_matrix:G(u,e,t),u_anchor:t,u_eye:[...E(y,k(t,g)),
g],u_picture:[r,n],u_horizon:[0,0,0,1]}),p.bindBuffer(p.ARRAY_BUFFER,this.buffer);for(let{first:M,count:P,color:S,width:R,
above:L}of m){let[U,I,J,ae=1]=S;l.programs.use(w,{u_width:R*x,u_nearer:Wi*v*(1+$i*L)});for(let V of[0,1])p.vertexAttribPointer(
V,3,p.FLOAT,!1,qs,qs*(M+V/2)),p.vertexAttrib4f(2+V,U,I,J,ae);p.drawArraysInstanced(p.TRIANGLE_STRIP,0,4,P)}p.bindVertexArray(
null),p.depthFunc(p.LESS),p.disable(p.BLEND)}layers(e,t,r){let[[n,s],[o,i],[,c]]=["critical","separatrices","nullclines"].
map(w=>this.shown(t,r,w)),l=JSON.stringify([n,s?.digest,o,i?.digest,c?.digest,Nr(r)]);if(this.drawn?.key===l)return this.
drawn.layers;let h=Js(s?.data??[],i?.data??[],{points:n,saddles:o}),{line:u,dot:m,rim:p,middle:f}=e,d=[],b=[],g=0,y=(w,M,P,S)=>{
let R=w.length/6;R&&d.push({first:g,count:R,color:M,width:P,above:S}),b.push(w),g+=R},x=e.nullclines.map((w,M)=>ji(c?.data??
[],M));x.forEach(w=>y(w,p,u[0],0)),x.forEach((w,M)=>y(w,e.nullclines[M].color,u[1],1)),y(Ve(Object.values(h.lines).flat()),
p,u[0],1.5),Object.entries(h.lines).forEach(([w,M],P)=>y(Ve(M),e.lines[w],u[1],2+P));let v=e.kinds.map((w,M)=>h.points[M]??
[]);return y(Ve(v,!0),p,m[0],6),e.kinds.forEach(({color:w},M)=>y(Ve([v[M]],!0),w,m[1],7)),y(Ve(v.filter((w,M)=>e.kinds[M].
turns),!0),f,m[2],8),this.send(b),this.drawn={key:l,layers:d},d}send(e){let{graphics:t}=this,r=t.context;this.array??=t.
counted(r.createVertexArray()),this.buffer??=t.counted(r.createBuffer()),r.bindVertexArray(this.array),r.bindBuffer(r.ARRAY_BUFFER,
this.buffer),r.bufferData(r.ARRAY_BUFFER,Float32Array.from(e.flatMap(n=>[...n])),r.STATIC_DRAW);for(let n of[0,1])r.enableVertexAttribArray(
n),r.vertexAttribDivisor(n,1);r.bindVertexArray(null)}at({place:e,position:t,height:r},n,s,o){let{geometry:i,structure:c}=this.
header,[l,h]=this.shown(s,o,"critical"),u=2*n.height/Math.max(r,1),[m,p]=["",Ks];for(let f=0;f<Math.min(l,h?.shape[0]??0);f+=
1){let[d,b,g,y]=[0,1,2,3].map(M=>Number(h?.data[ne*f+M])),x=T(K(i.frame,[d,b,g]),i.center),v=n.project(x);if(!v||Math.hypot(
...E(x,t))>4*Ks*u)continue;let w=.5*r*Math.hypot((v[0]-e[0])*n.aspect,v[1]-e[1]);w<p&&([m,p]=[c?.kinds[y]?.name??"",w])}
return m}dispose(){this.graphics.free("Buffer",this.buffer),this.graphics.free("VertexArray",this.array),this.array=this.
buffer=this.drawn=null}};function Nr([a,e,t]){return t<.5?a:e}var Xi={position:["nodes"],normal:["nodes"],cells:["cells"],triangles:["nodes","cells","scalar"],blocks:["cells"],cmap:[
"cmap"],image:["image"],step:["step"],scalars:["scalar"]},Zs=["padded","unit","open","nearest","rays"],Yi=8*(4/3),qi=2048,
Ki=["u_slices","u_slicesNext","u_image","u_stepImage","u_nodes"],Ji=0,_e=class{graphics;header;parts;earth;bodies;arrows;marks;tile;anchor=[
0,0,0];version=0;resources=new Map;scalarSteps="";most=null;tracing="";wanted=[];number=Ji+=1;constructor(e,t,r,n=null){
this.tile=n,this.graphics=e,this.header=t,this.parts=r,this.earth=new Ot(e,t,r),this.bodies=new Lt(e,t,r),this.arrows=new Rt(
e,t,r),this.marks=new Ft(e,t,r)}isReady(e,t=!1){let r=[!1,!0].map(i=>this.arrows.program(e,i));return[...["place","blur",
"colour","surface","smooth","probe"].filter(i=>t||i!=="smooth").map(i=>this.programs(i).ready),this.earth.isReady,this.bodies.
isReady,this.marks.isReady(e)].every(Boolean)&&r.every(i=>i?.ready??!0)}missing(e,t){let{geometry:r,slices:n,scalars:s,image:o,
pyramid:i,formula:c}=this.header,{trace:l}=n,h=["mesh",...l?.parts??["position",...r.planar?[]:["normal"]]];i&&!c&&h.push(
"places"),this.header.bodies?.runs.length&&h.push(...Ce),r.triangles&&h.push("triangles","blocks");for(let u of new Set(
[e,t]))l?h.push(...ie(this.header,u).map(m=>`flow/${m}`)):h.push(`slices/${u}`),n.channels===2&&h.push(`extra/${u}`);return h.
push(...this.scalarParts(e,t)),s.name!==null&&h.push("cmap"),o&&h.push("image","step"),[...new Set(h)].filter(u=>!this.fits(
u))}lacking(e){let t=this.missing(e,e).map(r=>r.startsWith("flow/")?Y(r):e);return[...new Set(t)]}scalarParts(e,t,r=this.
header.scalars){let{name:n,steps:s,number:o}=r;if(n===null)return[];let i=o?`/${o}`:"";return(s>1?[e,t]:[0,0]).map(c=>`s\
calars/${c}${i}`)}fits(e){let t=this.parts.get(e);if(!t)return!1;let{geometry:r,slices:n,image:s,mesh:o}=this.header,i=r.
shape.map(u=>Math.max(Math.ceil((u-1)/o.tileCells),1)),c=n.trace?.nodes??[],h={flow:[...c,t.shape[2]],unit:c,padded:[...c.
map(u=>u+2),3],slices:[n.count,r.rows.size,r.columns.size,n.channels],position:[...r.shape,3],mesh:r.triangles?t.shape:[
...i,t.shape[2]],step:s?[...s.stepSize].reverse():[]}[e.split("/")[0]];return!h||String(h)===String(t.shape)}make(e,t){let{
slices:r,geometry:n}=this.header,{trace:s}=r;if(!s)return!0;let o=this.part("padded"),i=c=>this.key(["padded"],c,s);return this.
put("position",i("position"),()=>Un(o,s,n.shape)),!n.planar&&!s.parts.includes("normal")&&this.put("normal",i("normal"),
()=>Vn(o,s,n.shape)),this.wanted=e,e.every(c=>this.trace(c,t))}prepare(){let{trace:e}=this.header.slices;e&&st(this.graphics,
this.header,e)}trace(e,t){let{graphics:r,header:n}=this,{trace:s,lags:o,sides:i}=n.slices,c=`slices/${e}`;if(!s||this.resources.
has(c))return!0;let l=ie(n,e).map(m=>`flow/${m}`),h=this.key([...l,...Zs],e,s,o,i,n.geometry.levels),u=null;if(!h||!r.common.
has(`slices ${h}`)){let{tracings:m}=r,p=h||`${this.number} ${e}`;this.tracing!==p&&this.stopTracing();let f=b=>this.parts.
get(b),d=m.get(p)??new at(r,n,s,f,e);if(m.set(this.tracing=p,d),u=d.advance(t),!u)return!1;this.stopTracing()}return this.
take(c,"Texture",h,()=>u,()=>{}),!0}put(e,t,r){let{graphics:n,parts:s}=this;if(s.get(e)?.digest===t)return;let o=n.stock.
get(t)?.part??{...r(),digest:t};n.release(s.get(e)),s.set(e,n.hold(o)),this.forget(e)}isMade(e){return!this.missing(e[0],
e[e.length-1]).length&&(!this.header.slices.trace||this.isLoaded(e))}stopTracing(){this.graphics.tracings.get(this.tracing)?.
dispose(),this.graphics.tracings.delete(this.tracing),this.tracing=""}part(e){let t=this.parts.get(e);if(!t)throw new Error(
`the part "${e}" of the scene is missing`);return t}forget(e){let[t,r]=e.split("/");["position","cells","triangles"].includes(
t)&&this.arrows.forget();let n=["slices","extra","flow"].includes(t);!n&&t!=="scalars"&&(this.earth.forget(e),this.version+=
1,this.most=null),Ce.includes(t)&&this.bodies.dispose();for(let s of n?[`slices/${r}`]:Xi[t]??[])this.drop(s);Zs.includes(
t)&&(this.wanted=[],this.dropSlices(NaN,NaN))}drop(e){let t=this.resources.get(e);this.resources.delete(e),t&&(t.users-=
1,!t.users&&(this.graphics.free(t.kind,t.object),this.graphics.common.delete(t.key)))}dispose(){for(let e of[...this.resources.
keys()])this.drop(e);this.stopTracing(),this.earth.dispose(),this.bodies.dispose(),this.arrows.dispose(),this.marks.dispose()}key(e,...t){
let r=e.map(n=>this.parts.has(n)?this.part(n).digest:"none");return r.every(Boolean)?JSON.stringify([r,t]):""}take(e,t,r,n,s){
let o=this.resources.get(e);if(o)return o.object;let{graphics:i}=this,c=r&&`${e.split("/")[0]} ${r}`,l=c?i.common.get(c):
void 0,h=l?.object??i.counted(n()),u=l??{kind:t,object:h,count:0,key:c,users:0};return u.users+=1,this.resources.set(e,u),
l||(u.count=s(h)||0),c&&i.common.set(c,u),h}get blocks(){return this.part("mesh")}get doublings(){let{geometry:e,mesh:t}=this.
header;return this.most??=As(e,this.blocks,this.part("position").data,t.tileCells)}cornersAt(e){let{triangles:t,shape:r}=this.
header.geometry;return t?ts(this.part("triangles").data,e):Qn(r,e)}isLoaded(e){return e.every(t=>this.resources.has(`sli\
ces/${t}`))}get tracedBytes(){let{slices:e,geometry:t}=this.header;return e.trace?[...this.resources.keys()].filter(n=>n.
startsWith("slices/")).length*Yi*e.count*t.rows.size*t.columns.size:0}load(e){for(let t of e)this.slices(t)}bindNodes(e){
let t=this.graphics.context,{shape:r,triangles:n,planar:s}=this.header.geometry;e.some((u,m)=>u!==this.anchor[m])&&this.
drop("nodes"),this.anchor=e;let[o,i]=this.nodesSize,c=this.texture("nodes",this.key(["position","normal"],i,e),u=>{mr(t,
i,o),t.bindTexture(t.TEXTURE_2D_ARRAY,u);let m=new Float32Array((s?3:6)*i*o);m.set(dt(this.part("position").data,e)),s||
m.set(Zn(this.part("normal").data),3*i*o);let p=[i,o,s?1:2];t.texImage3D(t.TEXTURE_2D_ARRAY,0,t.RGB32F,...p,0,t.RGB,t.FLOAT,
m),Qs(t,t.TEXTURE_2D_ARRAY)}),l=()=>this.parts.get("cells")?.data??Uint8Array.of(1),h=n?this.table("cells",this.key(["tr\
iangles","blocks"]),t.RGBA32UI,qi,()=>es(this.part("triangles").data,this.part("blocks").data)):this.table("cells",this.
key(["cells"],r),t.R8UI,this.parts.has("cells")?r[1]-1:1,l);this.bind("u_nodes",c),this.bind(n?"u_corners":"u_open",h)}get nodesSize(){
let{shape:e,triangles:t,rows:r,columns:n}=this.header.geometry;return t?[r.size,n.size]:e}bind(e,t){let r=this.graphics.
context;r.activeTexture(r.TEXTURE0+Q.indexOf(e)),r.bindTexture(Ki.includes(e)?r.TEXTURE_2D_ARRAY:r.TEXTURE_2D,t),r.activeTexture(
r.TEXTURE0+Q.length)}table(e,t,r,n,s){let o=this.graphics.context,i={[o.RGBA32UI]:[o.RGBA_INTEGER,o.UNSIGNED_INT,4],[o.R8UI]:[
o.RED_INTEGER,o.UNSIGNED_BYTE,1],[o.RG32F]:[o.RG,o.FLOAT,2],[o.RGBA32F]:[o.RGBA,o.FLOAT,4]},[c,l,h]=i[r];return this.texture(
e,t,u=>{let m=s(),p=Math.ceil(m.length/h/n);o.bindTexture(o.TEXTURE_2D,u),o.pixelStorei(o.UNPACK_ALIGNMENT,1);let f=Zi(m,
h*n*p);o.texImage2D(o.TEXTURE_2D,0,r,n,p,0,c,l,f),Qs(o,o.TEXTURE_2D)})}shares(e,t){let{geometry:r,scalars:n}=this.header,
{shape:s}=r,o=this.scalarParts(e,t);return[this.key(["triangles",...new Set(o)],s,n.low,n.high,n.log),()=>bt(o.map(l=>this.
part(l).data),n)]}texture(e,t,r){let n=this.graphics.context;return this.take(e,"Texture",t,()=>n.createTexture(),r)}slices(e){
let{slices:t,geometry:r}=this.header,n=this.key([`slices/${e}`,`extra/${e}`],r.levels,t.extra);return this.texture(`slic\
es/${e}`,n,s=>{let o=this.part(`slices/${e}`),[i,c,l,h]=o.shape,u=o.data,m=this.parts.get(`extra/${e}`)?.data,p=c*l,f=d=>{
let b=u.subarray(d*p*h,(d+1)*p*h);if(h===4)return b;let g=new Uint16Array(4*p),y=t.extra.indexOf(d),x=y<0?null:m?.subarray(
y*p,(y+1)*p);for(let v=0;v<p;v+=1)g[4*v]=b[2*v],g[4*v+1]=b[2*v+1],x&&(g[4*v+3]=x[v]);return g};this.fill(s,{width:l,height:c,
layers:i,channels:4,levels:r.levels},f)})}programs(e){let{programs:t}=this.graphics,{vertex:r,place:n,fullVertex:s,even:o,
surface:i,...c}=this.header.shaders;return e==="place"?t.get(r,n):e==="smooth"?t.get(r,i,"FLOWTEX_SMOOTH"):e==="surface"?
t.get(s,i):e==="blur"?t.get(s,o):t.get(s,c[e])}texels(e,t){let{graphics:r,header:n}=this,s=r.context,{slices:o,geometry:i}=n,
c=i.columns.size,l=this.slices(e),h=()=>{s.activeTexture(s.TEXTURE0),s.bindTexture(s.TEXTURE_2D_ARRAY,l),s.bindVertexArray(
null);let p=t.flatMap(f=>[f%c,Math.floor(f/c)]);r.programs.use(this.programs("probe"),{u_texels:p}),s.drawArrays(s.TRIANGLES,
0,3)},u=r.numbers(h,t.length,o.count),m=new Float32Array(u.buffer);return(p,f)=>{let[d,b,g,y]=m.subarray(4*(p*t.length+f));
return[d,b,g,y]}}image(e,t){let r=this.graphics.context;return this.texture(e,this.key([e],t),n=>{let{data:s,shape:o}=this.
part(e),[i,c,l=1]=o,h=Math.floor(Math.log2(Math.max(c,i))),u={width:c,height:i,layers:1,channels:l,levels:h};this.fill(n,
u,()=>s);let m=p=>t[p]?r.REPEAT:r.CLAMP_TO_EDGE;r.texParameteri(r.TEXTURE_2D_ARRAY,r.TEXTURE_WRAP_S,m(1)),r.texParameteri(
r.TEXTURE_2D_ARRAY,r.TEXTURE_WRAP_T,m(0))})}fill(e,t,r){let n=this.graphics.context,{width:s,height:o,layers:i,channels:c,
levels:l}=t;Qe(n,e,t),n.pixelStorei(n.UNPACK_ALIGNMENT,1);let h=c===1?n.RED:n.RGBA;for(let u=0;u<i;u+=1)n.texSubImage3D(
n.TEXTURE_2D_ARRAY,0,0,0,u,s,o,1,h,n.HALF_FLOAT,r(u));l&&n.generateMipmap(n.TEXTURE_2D_ARRAY)}dropSlices(e,t){let r=t+1<
this.header.slices.steps?t+1:0,n=[e,t,r,t+1,...this.wanted];for(let s of[...this.resources.keys()])s.startsWith("slices/")&&
!n.includes(Y(s))&&this.drop(s)}bindTextures(e,t){let r=this.graphics.context,{image:n,scalars:s}=this.header,o=String(this.
scalarParts(e,t));o!==this.scalarSteps&&this.drop("scalar"),this.scalarSteps=o,this.dropSlices(e,t),this.bind("u_slices",
this.slices(e)),this.bind("u_slicesNext",t===e?null:this.slices(t)),this.bind("u_image",n&&this.image("image",n.repeated)),
this.bind("u_stepImage",n&&this.image("step",n.repeat));let i=xn(this.parts.get("cmap")?.data??new Uint8Array(4),s);this.
bind("u_cmap",this.table("cmap",this.key(["cmap"],s.beyond),r.RGBA32F,i.length/4,()=>i));let[c,l]=this.shares(e,t);this.
bind("u_shares",s.name===null?null:this.table("scalar",c,r.RG32F,this.nodesSize[1],l));let h=()=>Jn(n?.alongI??[],n?.alongJ??
[]);this.bind("u_along",n&&this.table("along","",r.RG32F,Math.max(n.alongI.length,n.alongJ.length),h))}};function Qs(a,e){
a.texParameteri(e,a.TEXTURE_MIN_FILTER,a.NEAREST),a.texParameteri(e,a.TEXTURE_MAG_FILTER,a.NEAREST)}function Zi(a,e){if(a.
length===e)return a;let t=new a.constructor(e);return t.set(a),t}var Qi=60,ec=25,tc=9e8,rc=3.5,nc={slices:4,flow:24},Nt=class{layers=[];missing=[];wanted=0;pending=0;host;root;tiles=new Map;pyramid=null;chosen={
choices:new Map,steps:[],names:""};count=0;isWaiting=!1;hasAsked=!1;isOver=!1;failed=new Te;constructor(e,t){this.host=e,
this.root=t}has(e,t){return this.tiles.get(e)?.parts.has(t)??!1}fail(e,t){this.failed.add(this.need(e,t)),this.host.refine()}need(e,t){
return`${e} ${t} ${this.root.header.scalars.name}`}dispose(){this.isOver=!0;for(let e of[...this.tiles.keys()])this.drop(
e)}setPart(e,t){let{graphics:r,header:n}=this.root,s=this.tiles.get(e)??this.emptyTile();if(this.tiles.set(e,s),t.digest&&
s.parts.get(t.name)?.digest===t.digest)return;if(r.release(s.parts.get(t.name)),s.parts.set(t.name,r.hold(t)),t.name==="\
header"){let l=JSON.parse(new TextDecoder().decode(t.data));s.scene?.dispose(),l&&(l.geometry.reach=n.geometry.reach),s.
scene=l&&new _e(r,{...n,...l,pyramid:null,bodies:null,structure:null},s.parts,ce(e)),this.giveMap(s)}else s.scene?.forget(
t.name);let{names:o,steps:i}=this.chosen;this.missing=this.missing.filter(l=>!this.isHere(l,i));let c=Ar(this.chosen.choices,
l=>this.isHere(l,i));String([...c.keys()])!==o&&this.host.refine()}recolour(e={}){let{steps:t}=this.chosen;for(let r of this.
tiles.values()){let{scene:n,parts:s}=r;if(!n||(Object.assign(n.header,e),this.giveMap(r),n.forget("scalars"),(t.length?n.
scalarParts(t[0],t[t.length-1]):[]).every(c=>s.has(c))))continue;let i=[...s.keys()].filter(c=>c.startsWith("scalars/"));
for(let c of i)this.release(r,c)}}emptyTile(){return{parts:new Map,scene:void 0,used:this.count}}giveMap({scene:e,parts:t}){
let r=this.root.parts.get("cmap");r&&t.set("cmap",r),e?.forget("cmap")}arrange([e,t]){let{camera:r}=this.host;if(!r)return[];
let n=this.choose(r,[...new Set([e,t])]);return this.layers=[B,...[...n.keys()].filter(s=>s!==B)].flatMap(s=>{let o=s===
B?this.root:this.tiles.get(s)?.scene,i=(n.get(s)??[]).flatMap(l=>this.pyramid?[this.pyramid.finerPart(ce(l),s)]:[]),c=s===
B?[this.root.header.pyramid?.depth??0,0,0]:ce(s);return o?[{scene:o,key:c,covered:i}]:[]}),this.layers}choose(e,t){let{header:r}=this.
root,{settings:n,canvas:s,ratio:o}=this.host;if(!r.pyramid)return new Map;this.pyramid??=new mt(r.pyramid,Hn(r)??this.root.
part("places").data);let i=this.pyramid.choose({...e.sight(s.height/o),planes:e.planes,cellPixels:zn(r.pyramid,n),shownOn:this.
host.shownOn});this.count+=1;for(let u of i.keys()){let m=this.tiles.get(u);m&&(m.used=this.count)}let c=performance.now()+
ec,l=this.obtainable(Wn(i),t,r.pyramid.depth);this.missing=l.filter(u=>!this.isHere(u,t)),this.ask(),this.trim(t);for(let u of l)
this.isHere(u,t)&&this.load(u,t,c);let h=Ar(i,u=>this.isHere(u,t)&&this.load(u,t,c));return this.wanted=l.length,this.pending=
l.filter(u=>!this.isHere(u,t)||!this.isLoaded(u,t)).length,this.chosen={choices:i,steps:t,names:String([...h.keys()])},h}obtainable(e,t,r){
let n=[t,...t.map(i=>[i])],s=i=>n.some(c=>this.failed.has(this.need(i,c))),o=e.map(i=>{let[c,l,h]=ce(i);for(;c<r&&s(z([c,
l,h]));)[c,l,h]=[c+1,l>>1,h>>1];return c<r?z([c,l,h]):B});return[...new Set(o)].filter(i=>i!==B)}isHere(e,t){let r=this.
tiles.get(e)?.scene;return r===null||r?.missing(t[0],t[t.length-1]).length===0}isLoaded(e,t){let r=this.tiles.get(e)?.scene;
return r===null||(r?.isLoaded(t)??!1)}load(e,t,r){let n=this.tiles.get(e)?.scene;return!n||this.isLoaded(e,t)?!0:performance.
now()>r||!n.make(t,r)?(this.host.refine(),!1):(n.load(t),!0)}ask(){let{requests:e,lifetime:t}=this.host;this.isWaiting||
!(this.missing.length||this.hasAsked)||(this.isWaiting=!0,t.later(()=>{if(this.isWaiting=!1,this.isOver)return;this.hasAsked=
this.missing.length>0;let r=(o,i)=>this.tiles.get(o)?.scene?.lacking(i)??ie(this.root.header,i),n=this.missing.flatMap(o=>this.
chosen.steps.flatMap(i=>r(o,i))),s=[...new Set(n)].sort((o,i)=>o-i);e.wantTiles(this.missing.map(ce),s)},Qi))}trim(e){let t=0;
for(let[r,n]of[...this.tiles].sort(([,s],[,o])=>o.used-s.used)){let{parts:s,scene:o,used:i}=n,c=o?.header.slices.trace?"\
flow":"slices",l=[...s.keys()].filter(u=>u.startsWith(`${c}/`)),h=o?e.flatMap(u=>ie(o.header,u)):e;for(let u of l.slice(
0,Math.max(l.length-nc[c],0))){let m=Y(u);if(h.includes(m))continue;for(let f of[c,"extra"])this.release(n,`${f}/${m}`);
let p=[...s.keys()].filter(f=>Ee(f,m,this.root.header));for(let f of p)this.release(n,f)}for(let{data:u}of s.values())t+=
rc*u.byteLength;t+=o?.tracedBytes??0,t>(this.host.options.source?.memory??tc)&&i<this.count&&this.drop(r)}}drop(e){let t=this.
tiles.get(e);t?.scene?.dispose();for(let r of[...t?.parts.keys()??[]])this.release(t,r);this.tiles.delete(e)}release(e,t){
t!=="cmap"&&this.root.graphics.release(e?.parts.get(t)),e?.parts.delete(t)}};var It=class{scene=null;tiles=null;places=null;shown=null;view;renderer;next=[];isLate=!1;constructor(e){this.view=e,this.
renderer=new Mt(e,this),!e.graphics.gl&&e.panel.fail("This browser has no WebGL2 with floating-point targets, which are \
needed to draw the picture.","Turn on hardware acceleration in its settings, or use a recent Firefox, Chrome or Safari.")}open(e){
let{view:t}=this;this.leave(),this.scene=new _e(t.graphics,e,t.parts),this.tiles=new Nt(t,this.scene),this.places=new wt(
t.graphics)}leave(){this.tiles?.dispose(),this.scene?.dispose(),this.places?.dispose(),this.tiles=this.scene=this.places=
null}dispose(){this.leave(),this.renderer.dispose()}restart(e){this.renderer.restart(e)}resize(e,t){this.renderer.resize(
e,t)}refine(){this.renderer.refine()}arrange(e){let t=this.tiles?.arrange(e)??[];return this.view.root.dataset.tiles=String(
this.tiles?.pending??0),t}get smooth(){let{header:e,options:t}=this.view;return t.smooth!==void 0||!e?t.smooth??!1:this.
program(e).price<An}get isComing(){return!!this.tiles?.missing.length}get lacking(){let[e,t]=this.view.player.moment;return this.
scene?.missing(e,t)??[]}missing(e){return[...new Set(e.flatMap(t=>this.scene?.lacking(t)??[]))]}make(e,t){return this.next=
e,!this.missing(e).length&&!!this.scene?.make(e,t)}available(e){let{view:t,scene:r,shown:n,lacking:s}=this,{header:o,player:i}=t;
if(!o||!r)return null;let c=i.moment,l=i.playing?[1,2].map(p=>(c[1]+p)%o.slices.steps):[],h=this.missing([c[0],c[1],...this.
next,...l]);h.length&&t.requests.hasSteps&&!t.options.isComing?.()&&t.requests.wantSteps(h);let u=!s.length&&r.make(c.slice(
0,2),e);this.isLate=!u;let m=t.requests.hasMarks?r.marks.lacking(t.settings,c):[];return t.options.isComing?.()||t.requests.
wantMarks(m),t.root.dataset.lacking=String(s.length+m.length||+!u),t.panel.wait(s,u,this.renderer.leavesOut,m.length>0),
t.panel.showKinds(r.marks.legend(t.settings,c)),u&&String(c.slice(0,2))!==String(n?.slice(0,2))&&(t.trim(),t.change()),u?
this.shown=c:(s.length||t.request(),n&&r.isMade(n.slice(0,2))?n:null)}program(e,t=this.isClose(e),r=!this.view.player.playing){
let{fullVertex:n,fragment:s}=e.shaders,o=Bn(e,this.view.settings,t,r);return this.view.graphics.programs.get(n,s,...o)}isClose(e){
let{view:t}=this;if(!t.camera)return!1;let r=t.view([0,0,0],t.ratio),n=this.tiles?.layers.slice(1).map(({scene:s})=>s.header)??
[];return(n.length?n:[e]).some(s=>lt(s,t.settings,r))}frame(e,t){let{view:r,scene:n}=this,{graphics:s,header:o}=r;if(s.isLost||
!s.gl||!r.isVisible||!o||!n||r.canvas.width<2)return;this.next=[],r.advance(e);let i=this.available(t);r.camera||r.place();
let c=this.program(o);if(n.prepare(),!i||!r.camera||this.isLate&&r.sharp)return;if(c.error)return r.panel.fail("The shad\
er does not compile with this graphics driver.",c.error);if(!c.ready||!n.isReady(r.settings,this.smooth))return r.request();
let l=!r.sharp&&this.renderer.draw(c,i,t);l&&(o.slices.critical&&this.program(o,!0),r.player.varies&&this.program(o,this.
isClose(o),!1)),r.painted(l)}get canPick(){return!!this.places?.width&&!this.view.graphics.isLost}find(e,t){let{tiles:r,
shown:n,scene:s,view:o}=this,{camera:i}=o,c=r?.layers.length&&n?this.renderer.placeAt(n,e,t):null;if(!c||!i||!n||!s)return null;
let l=Es(c,s,i,n,[e,t]),h={place:[e,t],position:l.point.position,height:o.root.clientHeight};return l.point.mark=s.marks.
at(h,i,o.settings,n),l}};var Ir=class{canvas=document.createElement("canvas");root=document.createElement("div");graphics=Nn();lifetime=new it;held=new ot(
this.graphics);parts=this.held.all;camera=null;sharp=!1;isVisible=!0;isClear=!1;shownOn=null;dispose(){this.lifetime.isOver||
(this.lifetime.end(),this.requests.stop(),this.painter.dispose?.(),this.held.clear(),this.graphics.leave(this))}get scene(){
return this.painter.scene??null}get tiles(){return this.painter.tiles??null}setPart(e){let t=pe(e.name);return t&&this.tiles?.
setPart(t[0],{...e,name:t[1]}),t||!this.held.set(e)?!1:(this.scene?.forget(e.name),this.trim(),e.name==="cmap"&&this.tiles?.
recolour(),this.change(),!0)}lack(e,t,r=[]){t!==void 0&&this.tiles?.fail(t,r),this.tell(e)}trim(){this.held.trim(this.header,
this.options.source,this.player.moment.slice(0,2))}request(){!this.lifetime.isOver&&this.isVisible&&this.graphics.request(
this)}frame(e,t){if(!this.lifetime.isOver)try{this.painter.frame(e,t)}catch(r){this.fail(r)}}lost(){this.header&&this.painter.
open?.(this.header),this.sharp=!1}view(e,t){let{header:r,camera:n,player:s,rows:o}=this;if(!r||!n)throw new Error("no sc\
ene is shown yet");return Yn({header:r,camera:n,anchor:this.scene?.anchor??[0,0,0],player:s,rows:o},e,t)}find(e,t){return this.
painter.canPick?this.painter.find?.(e,t)??null:null}},Ct=class extends Ir{player;isClear=!0;panel;requests;options;header;settings;painter;ratio=1;host;isNew=!0;constructor(e,{
header:t,settings:r,player:n,source:s,isComing:o}){super(),this.host=e,this.header=t,this.settings=r,this.player=n,this.
options={source:s,isComing:o},this.panel={wait:()=>{},showKinds:()=>{},fail:(i,c)=>e.failed(i,c)},this.requests=new ft(s,
this),this.graphics.users.add(this),n.setHeader(t),this.painter=new It(this),this.requests.setHeader(t),this.painter.open(
t)}get isHeld(){return this.host.isHeld()}chooseColours(e){let{colours:t,part:r}=vn(this.header,e,this.parts);r&&this.setPart(
r),Object.assign(this.header,t),this.painter.scene?.forget("scalars"),this.tiles?.recolour(t),this.change()}look(e,t,r,n){
let{header:s,canvas:o}=this;this.ratio=n,this.camera=new de(e,s.limits,s.geometry.planar,t/r);let i=[t,r].map(c=>Math.max(
Math.round(c*n),1));(i[0]!==o.width||i[1]!==o.height)&&this.painter.resize(i[0],i[1]),this.change(!0)}tell(e){this.host.
failed(e,"")}fail(e){this.player.playing=!1,this.host.failed("The flow cannot be drawn.",String(e))}place(){}advance(e){
let{player:t,painter:r}=this;!t.playing||!t.advance(e,n=>r.make(n,e))||(this.host.advanced(),this.change())}change(e=!1){
this.painter.restart(e),this.isNew=!0,this.refine()}refine(){this.isNew||this.painter.refine(),this.sharp=!1,this.request()}painted(e){
this.sharp=e&&!this.player.playing,(this.isNew||e)&&this.host.painted(e),this.isNew=!1,this.sharp||this.request()}get rows(){
return this.canvas.height/this.ratio}};var ea=`// A picture of the flow on a web map; nothing beside it.

in vec3 flowtexPlaceOut;
in vec2 flowtexSidesOut;

uniform vec4 u_box;
uniform mat4 u_flowMatrix;
uniform sampler2D u_flowPicture;
uniform float u_opacity;
uniform float u_flowPixel; // share of the box's width that a pixel of the picture covers
uniform bool u_repeated;   // whether the map goes on at its other side

// Pixels beside such a side into whose colour what is clear beyond may be mixed, which keeps this share at least.
const float FLOWTEX_EDGE = 4.0;
const float FLOWTEX_LEAST_SHARE = 0.2;
const float FLOWTEX_ROUNDED = 1e-6; // share of the width by which nodes of a scene are rounded

out vec4 flowtexOut;

void main()
{
  float pixel = max(max(fwidth(flowtexSidesOut.x), fwidth(flowtexSidesOut.y)), u_flowPixel);
  vec2 inside = max(max(0.5 * pixel, FLOWTEX_ROUNDED) - flowtexSidesOut, 0.0);
  vec3 seen = flowtexPlaceOut;
  if (u_repeated)
    seen += (inside.x - inside.y) * u_box.z * u_flowMatrix[0].xyw;
  vec2 place = 0.5 + 0.5 * seen.xy / seen.z;
  if (seen.z <= 0.0 || place != clamp(place, 0.0, 1.0))
    discard;
  vec4 colour = texture(u_flowPicture, place);
  float side = min(flowtexSidesOut.x, flowtexSidesOut.y);
  if (u_repeated && side < FLOWTEX_EDGE * pixel && colour.a > FLOWTEX_LEAST_SHARE)
    colour /= colour.a;
  flowtexOut = u_opacity * colour;
}
`;var ta=`// A piece of a web map, in the cells of a grid over a box of a tile, and where it lies in a picture of the flow\
.
// \`projectTile\` is the map's.

uniform vec4 u_box;         // its corner and its size, in the tile's own units
uniform float u_mapCells;   // cells along a side of the grid
uniform mat4 u_flowMatrix;  // from the tile to the picture's clip space

out vec3 flowtexPlaceOut;   // as x, y and w
out vec2 flowtexSidesOut;   // ways to both sides of the box, as shares of its width

void main()
{
  vec2 cell = vec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1));
  vec2 place = u_box.xy + u_box.zw * cell / u_mapCells;
  flowtexPlaceOut = (u_flowMatrix * vec4(place, 0.0, 1.0)).xyw;
  flowtexSidesOut = vec2(cell.x, u_mapCells - cell.x) / u_mapCells;
  gl_Position = projectTile(place);
}
`;var ra=64,Vt=.02,Ut=Math.PI/2;function sa(a){let e=oc(a),t=ic(a.half).map(l=>cc(e,l)),r=t.map(l=>lc(l,a.latitude)),n=r.map(
([l])=>l),s={seen:Math.max(...t.map(l=>Math.acos(Math.min(l[2],1)))),south:Math.min(...n),north:Math.max(...n),aside:Math.
max(...r.map(([,l])=>Math.abs(l)))},o=Vt*s.seen,i=na(e,a,1)||s.north+o>Ut,c=na(e,a,-1)||s.south-o<-Ut;return s.seen+=o,s.
north=i?Ut:s.north+o,s.south=c?-Ut:s.south-o,s.aside=i||c?Math.PI:Math.min((1+Vt)*s.aside,Math.PI),s}function oc({bearing:a,
pitch:e,away:t}){let r=[Math.sin(a),Math.cos(a),0],n=T(k(r,Math.sin(e)),[0,0,-Math.cos(e)]),s=T(k(r,Math.cos(e)),[0,0,Math.
sin(e)]);return{eye:T([0,0,1],n,-t),look:k(n,t),right:[r[1],-r[0],0],up:s}}function ic([a,e]){let t=[];for(let r=0;r<=ra;r+=
1){let n=2*r/ra-1;t.push([n*a,e],[n*a,-e],[a,n*e],[-a,n*e])}return t}function cc({eye:a,look:e,right:t,up:r},[n,s]){let o=C(
T(T(e,t,n),r,s)),i=-A(a,o),c=i**2-A(a,a)+1;if(c>0&&i>0)return T(a,o,i-Math.sqrt(c));let l=1/O(a),h=C(a),u=C(T(o,h,-A(o,h)));
return T(k(h,l),u,Math.sqrt(1-l**2))}function lc([a,e,t],r){let n=t*Math.sin(r)+e*Math.cos(r),s=t*Math.cos(r)-e*Math.sin(
r);return[Math.asin(Math.min(Math.max(n,-1),1)),Math.atan2(a,s)]}function na({eye:a,look:e,right:t,up:r},{latitude:n,away:s,
half:o},i){let c=[0,i*Math.cos(n),i*Math.sin(n)],l=A(c,a)>=1-Vt,h=T(c,a,-1),u=A(h,e)/s**2,m=(1+Vt)*u;return l&&Math.abs(
A(h,t))<=m*o[0]&&Math.abs(A(h,r))<=m*o[1]}var Cr=1e-5,Dt=Math.atan(Math.sinh(Math.PI))*180/Math.PI,D=Math.PI/180,hc=88*D,aa='export it with projection="mercator"';
function be({lng:a,lat:e}){let t=Math.sin(_(e,-Dt,Dt)*D);return[a/360+.5,.5-Math.atanh(t)/(2*Math.PI)]}function Ht(a){return 1/
Math.cos(_(a,-Dt,Dt)*D)}var Bt=class{origin;slope;box;constructor(e,t,r){let n=e?.map;if(!n||!t)throw new Error(`the flo\
w is not on a map; ${aa}`);let[s,o]=r??[n[0],n[2]];this.box=[s,n[1],o,n[3]];let[i,c]=t.shape,l=(x,v)=>{let[w,M,P]=t.data.
subarray(3*(x*c+v)),S=be({lng:Math.atan2(M,w)/D,lat:Math.asin(P/Math.hypot(w,M,P))/D}),R=[n[0]+(n[2]-n[0])*v/(c-1),n[1]+
(n[3]-n[1])*x/(i-1)];return{place:S,position:R}},[h,u,m]=[l(1,1),l(i>>1,c>>1),l(i-2,c-2)],p=x=>x+Math.ceil(h.place[0]-x),
f=[p(m.place[0])-h.place[0],m.place[1]-h.place[1]];this.slope=[0,1].map(x=>f[x]/(m.position[x]-h.position[x])),this.origin=
[0,1].map(x=>h.place[x]-this.slope[x]*h.position[x]);let[d,b]=this.placeOf(u.position);if(!(Math.abs(d-p(u.place[0]))<Cr&&
Math.abs(b-u.place[1])<Cr))throw new Error(`the flow is on another map; ${aa}`);if(!r)return;this.slope=[1/(o-s),-1/(o-s)];
let y=[p(u.place[0]),u.place[1]];this.origin=[0,1].map(x=>y[x]-this.slope[x]*u.position[x])}placeOf(e){return[0,1].map(t=>this.
origin[t]+this.slope[t]*e[t])}lngLatOf(e){let[t,r]=this.placeOf(e);return[360*(t-.5),Math.atan(Math.sinh(2*Math.PI*(.5-r)))/
D]}positionOf(e){let[t,r]=e.map((s,o)=>(s-this.origin[o])/this.slope[o]),n=1/this.slope[0];return[t+n*Math.round((.5*(this.
box[0]+this.box[2])-t)/n),r]}look(e,t){let r=1/(512*2**e.zoom*this.slope[0]),[n,s]=this.positionOf(be(e.center)),[o,,i]=this.
box,c=n+(n<.5*(o+i)?1:-1)/this.slope[0];if(e.globe)return this.globeLooks(e,r,[n,c,t]);let l=this.wholeLook(e,r,[n,s,t]);
if(l)return[l];let h=[this.flatLook(e,r,[n,s,t])],u=.5*r*Math.min(e.width,e.height),m=n-u<=o&&n+u>=i,p=r*ia(e);return!m&&
Math.abs(c-_(c,o,i))<p&&h.push(this.flatLook(e,r,[c,s,t])),h}get isAround(){let[e,,t]=this.box;return Math.abs((t-e)*this.
slope[0]-1)<Cr}globeLooks(e,t,[r,n,s]){let o=sa(uc(e,1/(t*this.slope[0]))),[i,,c]=this.box,l=.5*o.aside/(Math.PI*this.slope[0]),
u=!(r-l<=i&&r+l>=c)&&Math.abs(n-_(n,i,c))<l;return u&&this.isAround&&4*l>=c-i?[this.globeLook(e,t,{...o,aside:Math.PI},[
.5*(i+c),s])]:(u?[r,n]:[r]).map(p=>this.globeLook(e,t,o,[p,s]))}wholeLook(e,t,[r,n,s]){let[o,,i]=this.box;if(!this.isAround||
e.pitch>0)return null;let c=t*ia(e);if(r-c>o||r+c<i)return null;let{height:l}=e;e.bearing&&(l=2*c/t);let h=(i-o)/t;return this.
flatLook({...e,width:h,height:l,bearing:0},t,[.5*(o+i),n,s])}flatLook({width:e,height:t,bearing:r,pitch:n,fov:s},o,[i,c,
l]){let[h,u]=[r*D,n*D],m=.5*t*o,p=m/Math.tan(.5*s*D);return{state:{position:[i-p*Math.sin(u)*Math.sin(h),c-p*Math.sin(u)*
Math.cos(h),l+p*Math.cos(u)],focal_point:[i,c,l],up:[Math.sin(h),Math.cos(h),0],parallel:n===0,parallel_scale:m,view_angle:s},
width:e,height:t}}globeLook(e,t,r,[n,s]){let o=1/(t*this.slope[0]),[i,c]=[r.south,r.north].map(f=>be({lng:0,lat:f/D})[1]),
l=(.5*(i+c)-this.origin[1])/this.slope[1],[h,u]=[r.aside/Math.PI,i-c],m={position:[n,l,s+1/this.slope[0]],focal_point:[n,
l,s],up:[0,1,0],parallel:!0,parallel_scale:.5*u/this.slope[0],view_angle:e.fov},p=new Ur(this,e.center,r.seen);return{state:m,
width:h*o,height:u*o,shownOn:p}}};function uc({center:a,width:e,height:t,bearing:r,pitch:n,fov:s},o){let i=o*Ht(a.lat)/(2*
Math.PI);return{latitude:a.lat*D,bearing:r*D,pitch:n*D,away:.5*t/Math.tan(.5*s*D)/i,half:[.5*e/i,.5*t/i]}}var Ur=class{mercator;middle;cosine;seen;constructor(e,{
lng:t,lat:r},n){this.mercator=e,this.middle=oa(t,r),this.cosine=1/Ht(r),this.seen=n}sees(e){let[t,r,,n]=Array.from(e);return Math.
acos(_(A(oa(...this.mercator.lngLatOf([t,r])),this.middle),-1,1))<=this.seen+this.angle(n)}scale(e){let[,t,,r]=Array.from(
e),n=Math.abs(2*Math.PI*(this.mercator.placeOf([0,t])[1]-.5)),s=Math.max(n-this.angle(r),0);return Math.min(1/Math.cosh(
s)/this.cosine,1)}angle(e){return 2*Math.PI*this.mercator.slope[0]*e}};function oa(a,e){let t=Math.cos(e*D);return[t*Math.
cos(a*D),t*Math.sin(a*D),Math.sin(e*D)]}function ia({width:a,height:e,pitch:t,fov:r}){let[n,s]=[t*D,.5*r*D],o=n+s;if(o>hc)
return 1/0;let c=.5*e/Math.tan(s)*Math.cos(n)*(Math.tan(o)-Math.tan(n));return Math.hypot(c,.5*a*Math.cos(n)*Math.cos(s)/
Math.cos(o))}var Vr=8192,mc=22,ca=512,pc=[64,256],fc=.25,Gt=class{view;isUsed=!1;texture;shown=null;next=null;constructor(e,t){this.view=
t,this.texture=e.createTexture()}dispose(e){this.view.dispose(),e?.deleteTexture(this.texture)}follow(e,t){this.isUsed=this.
view.isVisible=e!==void 0,this.view.shownOn=e?.shownOn??null,e?this.view.look(e.state,e.width,e.height,t):this.shown=this.
next=null}painted(e){let{camera:t}=this.view;t&&this.isUsed&&(this.next={camera:t,isComplete:e})}get isComplete(){let{view:e,
next:t,shown:r}=this;return!this.isUsed||e.sharp&&!t&&!!r?.isComplete&&!e.tiles?.pending}upload(e,t){if(this.next){e.pixelStorei(
e.UNPACK_FLIP_Y_WEBGL,!0),e.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!0),e.texImage2D(e.TEXTURE_2D,0,e.RGBA,e.RGBA,e.
UNSIGNED_BYTE,this.view.canvas);for(let r of[e.TEXTURE_WRAP_S,e.TEXTURE_WRAP_T])e.texParameteri(e.TEXTURE_2D,r,e.CLAMP_TO_EDGE);
t&&e.generateMipmap(e.TEXTURE_2D),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_MIN_FILTER,t?e.LINEAR_MIPMAP_LINEAR:e.LINEAR),e.
texParameteri(e.TEXTURE_2D,e.TEXTURE_MAG_FILTER,e.LINEAR),this.shown=this.next,this.next=null}}draw(e){let{gl:t,programs:r,
mercator:n,globe:s}=e,{vertexShaderPrelude:o,define:i}=e.shaderData,c=r.get(`${i}
${o}
${ta}`,ea);if(!c.ready)return c.error;if(t.activeTexture(t.TEXTURE0),t.bindTexture(t.TEXTURE_2D,this.texture),this.upload(
t,s),!this.shown)return!0;let{camera:l}=this.shown,h=Math.floor(_(e.zoom,0,mc)),u=n.placeOf(l.state.focal_point),m=2**h,
p=[Math.floor(u[0]*m),_(Math.floor(u[1]*m),0,m-1)],f=Math.floor(p[0]/m),d={z:h,x:p[0]-f*m,y:p[1]},b=L=>L.map((U,I)=>(U*m-
p[I])*Vr),[g,y,x,v]=n.box,[w,M]=[[g,y],[x,v]].map(L=>b(n.placeOf(L)));t.bindVertexArray(e.array);let P=s?dc(e,Math.max(x-
g,v-y)*Math.abs(n.slope[0])):1,S=s?0:Math.round(be(e.center)[0]-u[0]),R=0;e.isRepeated&&!s&&(R=Math.ceil(t.drawingBufferWidth/
(ca*2**e.zoom)));for(let L=-R;L<=R;L+=1){let U={wrap:f+S+L,canonical:d},I=e.getProjectionData({tileID:U,applyGlobeMatrix:s});
r.use(c,{u_projection_matrix:I.mainMatrix,u_projection_fallback_matrix:I.fallbackMatrix,u_projection_tile_mercator_coords:I.
tileMercatorCoords,u_projection_clipping_plane:I.clippingPlane,u_projection_transition:I.projectionTransition,u_box:[...w,
M[0]-w[0],M[1]-w[1]],u_mapCells:P,u_flowMatrix:bc(this.view.header,l,n,p,1/(m*Vr)),u_flowPicture:0,u_flowPixel:2*l.height/
this.view.canvas.height/(x-g),u_repeated:!!this.view.header.ends,u_opacity:e.opacity}),t.drawArraysInstanced(t.TRIANGLE_STRIP,
0,2*P+2,P)}return t.bindVertexArray(null),!0}};function dc({zoom:a,center:e},t){let n=ca*2**a*Ht(e.lat)/(2*Math.PI),s=t*
Math.PI*Math.sqrt(n/(2*fc));return _(Math.ceil(s),...pc)}function bc({geometry:a},e,t,r,n){let{center:s,frame:o}=a,{focal_point:i}=e.
state,c=F(o,E(i,s)),l=G(a,e,c),h=[0,1].map(f=>F(o,[0,1].map(d=>d===f?n/t.slope[f]:0).concat(0))),u=t.placeOf(i),m=[0,1].
map(f=>(r[f]*n*Vr-u[f])/t.slope[f]).concat(0);return[...h,[0,0,0],F(o,m)].flatMap((f,d)=>[0,1,2,3].map(b=>f.reduce((g,y,x)=>g+
l[4*x+b]*y,d===3?l[12+b]:0)))}var zt=class{atOnce=1;header;parts=[];tiles=new Map;known;texts;constructor(e,t,r,n){this.header=e,this.known=r,this.texts=
n;for(let s of t){let[{name:o,digest:i},c]=s,l=pe(o)?.[0];l?this.tiles.set(l,[...this.tiles.get(l)??[],s]):this.parts.push(
s),l&&c&&n.set(i,c)}}load=(e,t)=>{let r=((e&&this.tiles.get(z(e)))??[]).filter(([{name:n}])=>{let s=pe(n)?.[1]??"",o=Y(s),
i=s.startsWith("scalars/")&&!Ee(s,o,this.header);return Number.isNaN(o)||t.includes(o)||i});return Promise.all(r.map(n=>this.
unpacked(n)))};async unpacked([e,t]){let{digest:r,name:n}=e,s=this.known.get(r);return s?{...s,name:n}:nn(e,t||(this.texts.
get(r)??""))}async kept(e){let t=await this.unpacked(e);return this.known.set(t.digest,t),t}};var De=class{};var ge=class extends Error{},q=class extends ge{_tag="NotFoundError";name="NotFoundError";path;found;constructor(e,t={}){
super(`Not found: ${e}`,{cause:t.cause}),this.path=t.path,this.found=t.found}},H=class extends ge{_tag="InvalidMetadataE\
rror";name="InvalidMetadataError";path;constructor(e,t={}){super(e,{cause:t.cause}),this.path=t.path}},Be=class extends ge{_tag="\
UnknownCodecError";name="UnknownCodecError";codec;constructor(e){super(`Unknown codec: ${e}`),this.codec=e}},He=class extends ge{_tag="\
CodecPipelineError";name="CodecPipelineError";direction;codec;chunkPath;constructor(e){let t=[`Failed to ${e.direction} \
chunk`,e.codec&&`via codec "${e.codec}"`,e.chunkPath&&`at ${e.chunkPath}`].filter(Boolean);super(t.join(" "),{cause:e.cause}),
this.direction=e.direction,this.codec=e.codec,this.chunkPath=e.chunkPath}};var ye=class extends ge{_tag="UnsupportedError";name="UnsupportedError";feature;constructor(e){super(`Unsupported: ${e}`),
this.feature=e}};var Ge=class{},ze=class{},We=class{};function ha(){if(typeof SharedArrayBuffer>"u")throw new Error("SharedArrayBuffer is not available. In browsers, this req\
uires Cross-Origin-Opener-Policy and Cross-Origin-Embedder-Policy headers to be set.")}function ua(a,e){return e?new SharedArrayBuffer(
a):new ArrayBuffer(a)}function $e(a){let e=new TextDecoder().decode(a);try{return JSON.parse(e)}catch(t){throw new H("Fa\
iled to decode JSON",{cause:t})}}function Dr(a,e){let t=e/2,r=e-1,n=0;for(let s=0;s<a.length;s+=e)for(let o=0;o<t;o+=1)n=
a[s+o],a[s+o]=a[s+r-o],a[s+r-o]=n}function $t(a){if(a==="v2:object")return globalThis.Array;let e=a.match(/v2:([US])(\d+)/);
if(e){let[,r,n]=e;return(r==="U"?We:ze).bind(null,Number(n))}if(a==="string")return globalThis.Array;let t={int8:Int8Array,
int16:Int16Array,int32:Int32Array,int64:globalThis.BigInt64Array,uint8:Uint8Array,uint16:Uint16Array,uint32:Uint32Array,
uint64:globalThis.BigUint64Array,float16:globalThis.Float16Array,float32:Float32Array,float64:Float64Array,bool:Ge}[a];if(!t)
throw new H(`Unknown or unsupported dataType: ${a}`);return t}function jt(a,e){let t=a.length;typeof e=="string"&&(e=e===
"C"?Array.from({length:t},(s,o)=>o):Array.from({length:t},(s,o)=>t-1-o)),ba(t===e.length,"Order length must match the nu\
mber of dimensions.");let r=1,n=new Array(t);for(let s=e.length-1;s>=0;s--)n[e[s]]=r,r*=a[e[s]];return n}function ma({name:a,
configuration:e}){if(a==="default"){let t=e?.separator??"/";return r=>["c",...r].join(t)}if(a==="v2"){let t=e?.separator??
".";return r=>r.join(t)||"0"}throw new H(`Unknown chunk key encoding: ${a}`)}function la(a){if(a==="|O")return{dataType:"\
v2:object"};let e=a.match(/^([<|>])(.*)$/);if(!e)throw new H(`Invalid dtype: ${a}`);let[,t,r]=e,n={b1:"bool",i1:"int8",u1:"\
uint8",i2:"int16",u2:"uint16",i4:"int32",u4:"uint32",i8:"int64",u8:"uint64",f2:"float16",f4:"float32",f8:"float64"}[r]??
(r.startsWith("S")||r.startsWith("U")?`v2:${r}`:void 0);if(!n)throw new H(`Unsupported or unknown dtype: ${a}`);return t===
"|"?{dataType:n}:{dataType:n,endian:t==="<"?"little":"big"}}function gc(a){return(a.id==="fixedscaleoffset"||a.id==="num\
codecs.fixedscaleoffset")&&typeof a.scale=="number"&&typeof a.offset=="number"&&(a.astype===void 0||typeof a.astype=="st\
ring")&&(a.dtype===void 0||typeof a.dtype=="string")}function pa(a,e={}){let t=[],r=la(a.dtype);a.order==="F"&&t.push({name:"\
transpose",configuration:{order:"F"}});for(let s of a.filters??[]){if(s.id==="fixedscaleoffset"||s.id==="numcodecs.fixed\
scaleoffset"){if(!gc(s))throw new H(`Invalid fixedscaleoffset filter: ${JSON.stringify(s)}`);t.push({name:"scale_offset",
configuration:{scale:s.scale,offset:s.offset}});let c=s.astype??s.dtype;if(c!==void 0&&c!==a.dtype){let l=la(c).dataType;
if(!Wt(l,"number")&&!Wt(l,"bigint"))throw new H(`fixedscaleoffset astype must be a numeric data type, got ${c}`);t.push(
{name:"cast_value",configuration:{data_type:l,rounding:"nearest-even",out_of_range:"wrap"}})}continue}let{id:o,...i}=s;t.
push({name:`numcodecs.${o}`,configuration:i})}if("endian"in r&&r.endian==="big"&&t.push({name:"bytes",configuration:{endian:"\
big"}}),a.compressor){let{id:s,...o}=a.compressor;t.push({name:`numcodecs.${s}`,configuration:o})}let n;return globalThis.
Array.isArray(e._ARRAY_DIMENSIONS)&&(n=e._ARRAY_DIMENSIONS),{zarr_format:3,node_type:"array",shape:a.shape,data_type:r.dataType,
chunk_grid:{name:"regular",configuration:{chunk_shape:a.chunks}},chunk_key_encoding:{name:"v2",configuration:{separator:a.
dimension_separator??"."}},codecs:t,fill_value:a.fill_value,dimension_names:n,attributes:e}}function fa(a,e={}){return{zarr_format:3,
node_type:"group",attributes:e}}function Wt(a,e){if(e!=="number"&&e!=="bigint"&&e!=="boolean"&&e!=="object"&&e!=="string")
return a===e;let t=a==="bool";if(e==="boolean")return t;let r=a.startsWith("v2:U")||a.startsWith("v2:S")||a==="string";if(e===
"string")return r;let n=a==="int64"||a==="uint64";if(e==="bigint")return n;let s=a==="v2:object";return e==="object"?s:!r&&
!n&&!t&&!s}function da(a){return a?.name==="sharding_indexed"}function Xt(a){if((a.data_type==="uint64"||a.data_type==="\
int64")&&a.fill_value!=null)return BigInt(a.fill_value);let e=a.data_type==="float16"||a.data_type==="float32"||a.data_type===
"float64";if(typeof a.fill_value=="string"&&e){let t={NaN:NaN,Infinity:1/0,"-Infinity":-1/0};if(a.fill_value in t)return t[a.
fill_value]}return a.fill_value}function Br(a,...e){if(!e.some(t=>a instanceof t))throw a}function ba(a,e=""){if(!a)throw new Error(e)}async function ga(a,{
format:e,signal:t}){let r;if(a instanceof ArrayBuffer)r=new Response(a);else{let n=new Uint8Array(a.buffer,a.byteOffset,
a.byteLength);r=new Response(n.slice().buffer)}ba(r.body,"Response does not contain body.");try{return await new Response(
r.body.pipeThrough(new DecompressionStream(e),{signal:t})).arrayBuffer()}catch{throw t?.throwIfAborted(),new Error(`Fail\
ed to decode ${e}`)}}var ya=yc();function yc(){let a=new Uint32Array([305419896]);return new Uint8Array(a.buffer,a.byteOffset,a.byteLength)[0]!==
18}function xa(a){return"BYTES_PER_ELEMENT"in a?a.BYTES_PER_ELEMENT:4}var je=class a{kind="array_to_bytes";#e;#t;#r;#s;#n;constructor(e,t){
this.#n=e?.endian,this.#t=$t(t.dataType),this.#s=t.shape,this.#e=jt(t.shape,"C");let r=new this.#t(0);this.#r=r.BYTES_PER_ELEMENT}static fromConfig(e,t){
return new a(e,t)}encode(e){let t=new Uint8Array(e.data.buffer);return ya&&this.#n==="big"&&(t=t.slice(),Dr(t,xa(this.#t))),
t}computeEncodedSize(e){return e}decode(e){return ya&&this.#n==="big"&&(e=e.slice(),Dr(e,xa(this.#t))),e.byteOffset%this.#r!==
0&&(e=e.slice()),{data:new this.#t(e.buffer,e.byteOffset,e.byteLength/this.#r),shape:this.#s,stride:this.#e}}};var Yt=class{};function qt(a){return()=>{throw new ye(`${a} encode`)}}var Kt=class a{kind="bytes_to_bytes";static fromConfig(){return new a}encode=qt("crc32c");decode(e){return new Uint8Array(
e.buffer,e.byteOffset,e.byteLength-4)}computeEncodedSize(e){return e+4}};var Jt=class{};var Zt=class a{kind="bytes_to_bytes";static fromConfig(e){return new a}encode=qt("gzip");async decode(e){let t=await ga(
e,{format:"gzip"});return new Uint8Array(t)}};var Xe=class{};var Qt=class{};var er=class{};var tr=class{};var Ye=class{};var rr=class{};function xc(){let a=()=>import("numcodecs/blosc").then(s=>s.default),e=()=>import("numcodecs/lz4").then(s=>s.default),t=()=>import("numcodecs/zstd").
then(s=>s.default),r=()=>Zt,n=()=>rr;return new Map().set("blosc",a).set("lz4",e).set("zstd",t).set("gzip",r).set("zlib",
n).set("transpose",()=>tr).set("bytes",()=>je).set("crc32c",()=>Kt).set("vlen-utf8",()=>Ye).set("json2",()=>Xe).set("bit\
round",()=>De).set("cast_value",()=>Yt).set("scale_offset",()=>Qt).set("numcodecs.blosc",a).set("numcodecs.lz4",e).set("\
numcodecs.zstd",t).set("numcodecs.gzip",r).set("numcodecs.zlib",n).set("numcodecs.vlen-utf8",()=>Ye).set("numcodecs.shuf\
fle",()=>er).set("numcodecs.delta",()=>Jt).set("numcodecs.bitround",()=>De).set("numcodecs.json2",()=>Xe)}var qe=xc();function Ke(a){
let e;function t(){return e||(e=vc(a)),e}async function r(n,s,o){try{return await o()}catch(i){throw new He({direction:n,
codec:s,cause:i})}}return{async encode(n){let s=await t();for(let{name:i,codec:c}of s.arrayToArray)n=await r("encode",i,
()=>c.encode(n));let o=await r("encode",s.arrayToBytes.name,()=>s.arrayToBytes.codec.encode(n));for(let{name:i,codec:c}of s.
bytesToBytes)o=await r("encode",i,()=>c.encode(o));return o},async decode(n){let s=await t();for(let i=s.bytesToBytes.length-
1;i>=0;i--){let{name:c,codec:l}=s.bytesToBytes[i];n=await r("decode",c,()=>l.decode(n))}let o=await r("decode",s.arrayToBytes.
name,()=>s.arrayToBytes.codec.decode(n));for(let i=s.arrayToArray.length-1;i>=0;i--){let{name:c,codec:l}=s.arrayToArray[i];
o=await r("decode",c,()=>l.decode(o))}return o},async computeEncodedSize(n){let s=await t(),o=va(s.arrayToBytes.name,s.arrayToBytes.
codec,n);for(let{name:i,codec:c}of s.bytesToBytes)o=va(i,c,o);return o}}}function va(a,e,t){if(!e.computeEncodedSize)throw new H(
`Codec "${a}" cannot compute its encoded size; it is not a fixed-size codec and cannot be used in a sharding index pipel\
ine`);return e.computeEncodedSize(t)}async function vc(a){let e=a.codecs.map(async o=>{let i=await qe.get(o.name)?.();if(!i)
throw new Be(o.name);return{Codec:i,meta:o}}),t=[],r,n=[],s={...a};for await(let{Codec:o,meta:i}of e){let c=o.fromConfig(
i.configuration,s);switch(c.kind){case"array_to_array":t.push({name:i.name,codec:c}),c.getEncodedMeta&&(s=c.getEncodedMeta(
s));break;case"array_to_bytes":r={name:i.name,codec:c};break;default:n.push({name:i.name,codec:c})}}if(!r){if(!wc(s))throw new H(
`Cannot encode ${s.dataType} to bytes without a codec`);r={name:"bytes",codec:je.fromConfig({endian:"little"},s)}}return{
arrayToArray:t,arrayToBytes:r,bytesToBytes:n}}function wc(a){return a.dataType!=="v2:object"&&a.dataType!=="string"}var wa=18446744073709551615n;function Ma(a,e,t,r){if(!a.store.getRange)throw new ye("sharding requires a store with getR\
ange");let n=a.store.getRange.bind(a.store),s=e.map((l,h)=>l/r.chunk_shape[h]),o=Ke({dataType:"uint64",shape:[...s,2],codecs:r.
index_codecs,fillValue:null}),i=16*s.reduce((l,h)=>l*h,1),c={};return async(l,h)=>{let u=l.map((v,w)=>Math.floor(v/s[w])),
m=a.resolve(t(u)).path;m in c||(c[m]=(async()=>{let v=await o.computeEncodedSize(i),w=await n(m,{suffixLength:v},h);return w?
await o.decode(w):null})().catch(v=>{throw delete c[m],v}));let p=await c[m];if(p===null)return;let{data:f,shape:d,stride:b}=p,
g=l.map((v,w)=>v%d[w]).reduce((v,w,M)=>v+w*b[M],0),y=f[g],x=f[g+1];if(!(y===wa&&x===wa))return n(m,{offset:Number(y),length:Number(
x)},h)}}var se=class a{store;path;constructor(e,t="/"){this.store=e,this.path=t}resolve(e){let t=new URL(`file://${this.path.endsWith(
"/")?this.path:`${this.path}/`}`);return new a(this.store,decodeURIComponent(new URL(e,t).pathname))}};function sr(a){return new se(
a??new Map)}var xe=class extends se{kind="group";#e;constructor(e,t,r){super(e,t),this.#e=r}get attrs(){return this.#e.attributes}};
function Ea(a){return a.find(t=>t.name==="transpose")?.configuration?.order??"C"}function Mc(a,e){let t=new Map(e.map((r,n)=>[
r,n]));return a.filter(r=>t.has(r)).map(r=>t.get(r))}function Sa(a){return(e,t)=>{let r=globalThis.Array.isArray(a)&&t?Mc(
a,t):a;return jt(e,r)}}var nr=Symbol("zarrita.context");function Ec(a,e){let{configuration:t}=e.codecs.find(da)??{},r={encodeChunkKey:ma(e.chunk_key_encoding),TypedArray:$t(e.data_type),
fillValue:e.fill_value};if(t){let s=Ea(t.codecs);return{...r,kind:"sharded",chunkShape:t.chunk_shape,codec:Ke({dataType:e.
data_type,shape:t.chunk_shape,codecs:t.codecs,fillValue:e.fill_value}),getStrides:Sa(s),getChunkBytes:Ma(a,e.chunk_grid.
configuration.chunk_shape,r.encodeChunkKey,t)}}let n=Ea(e.codecs);return{...r,kind:"regular",chunkShape:e.chunk_grid.configuration.
chunk_shape,codec:Ke({dataType:e.data_type,shape:e.chunk_grid.configuration.chunk_shape,codecs:e.codecs,fillValue:e.fill_value}),
getStrides:Sa(n),async getChunkBytes(s,o){let i=r.encodeChunkKey(s),c=a.resolve(i).path;return a.store.get(c,o)}}}var he=class extends se{kind="\
array";#e;[nr];constructor(e,t,r){super(e,t),this.#e={...r,fill_value:Xt(r)},this[nr]=Ec(this,this.#e)}get attrs(){return this.#e.
attributes}get dimensionNames(){return this.#e.dimension_names}get fillValue(){return this.#e.fill_value}get shape(){return this.#e.
shape}get chunks(){return this[nr].chunkShape}get dtype(){return this.#e.data_type}async getChunk(e,t,r){r?.useSharedArrayBuffer&&
ha();let n=this[nr],s=await n.getChunkBytes(e,t);if(!s){let o=n.chunkShape.reduce((c,l)=>c*l,1),i;if(r?.useSharedArrayBuffer){
let c=new n.TypedArray(0);if(!("BYTES_PER_ELEMENT"in c))console.warn("zarrita: useSharedArrayBuffer is not supported for\
 non-buffer-backed data types."),i=new n.TypedArray(o);else{let l=ua(o*c.BYTES_PER_ELEMENT,!0);i=new n.TypedArray(l,0,o)}}else
i=new n.TypedArray(o);return i.fill(n.fillValue),{data:i,shape:n.chunkShape,stride:n.getStrides(n.chunkShape)}}return n.
codec.decode(s)}is(e){return Wt(this.dtype,e)}};function Ta(a,e){let t=a;for(let r of e)t instanceof Promise?t=t.then(n=>r(n)):t=r(t);return t}function Aa(a,...e){return Ta(a,e)}async function Ra(a){let e=a.store.arrayExtensions;return e?.length?await Aa(a,...e):a}var ar=Sc();function Sc(){let a=new WeakMap;
function e(t){let r=a.get(t)??{v2:0,v3:0};return a.set(t,r),r}return{increment(t,r){e(t)[r]+=1},versionMax(t){let r=e(t);
return r.v3>r.v2?"v3":"v2"}}}async function Tc(a,e){let t=await a.store.get(a.resolve(".zattrs").path,{signal:e});return t?
$e(t):{}}async function Ac(a,e={}){let t="store"in a?a:new se(a),{signal:r}=e,n={};return(e.attrs??!0)&&(n=await Tc(t,r)),
r?.throwIfAborted(),e.kind==="array"?_a(t,n,r):e.kind==="group"?Pa(t,n,r):_a(t,n,r).catch(s=>(Br(s,q,H),Pa(t,n,r)))}async function _a(a,e,t){
let{path:r}=a.resolve(".zarray"),n=await a.store.get(r,{signal:t});if(!n)throw new q("v2 array",{path:r});return ar.increment(
a.store,"v2"),Ra(new he(a.store,a.path,pa($e(n),e)))}async function Pa(a,e,t){let{path:r}=a.resolve(".zgroup"),n=await a.
store.get(r,{signal:t});if(!n)throw new q("v2 group",{path:r});return ar.increment(a.store,"v2"),new xe(a.store,a.path,fa(
$e(n),e))}async function _c(a,e){let{store:t,path:r}=a.resolve("zarr.json"),n=await a.store.get(r,{signal:e});if(!n)throw new q(
"v3 array or group",{path:r});let s=$e(n);return s.node_type==="array"&&(s.fill_value=Xt(s)),s.node_type==="array"?Ra(new he(
t,a.path,s)):new xe(t,a.path,s)}async function Pc(a,e={}){let t="store"in a?a:new se(a),r=await _c(t,e.signal);if(ar.increment(
t.store,"v3"),e.kind===void 0||e.kind==="array"&&r instanceof he||e.kind==="group"&&r instanceof xe)return r;let n=r instanceof
he?"array":"group";throw new q(`${e.kind} at ${t.path}`,{path:t.path,found:n})}async function ee(a,e={}){let t="store"in
a?a.store:a,r=ar.versionMax(t),n=r==="v2"?ee.v2:ee.v3,s=r==="v2"?ee.v3:ee.v2;return n(a,e).catch(o=>(Br(o,q,H),s(a,e)))}
ee.v2=Ac;ee.v3=Pc;var La=[300,1e3,3e3],ka=2e4,Lc=[401,403,404,410],Fa=200,kc=429,Oc=500,Fc=2197175160,Hr=4,Nc=8,Ic=1<<28,$=class extends Error{fault;detail;constructor(e,t,r=t){
super(t),this.fault=e,this.detail=r}},Cc=Array.from({length:4},(a,e)=>Uint32Array.from({length:256},(t,r)=>{let n=r;for(let s=0;s<
8*(e+1);s+=1)n=n>>>1^(n&1?Fc:0);return n}));function Uc(a){let[e,t,r,n]=Cc,s=a.length-a.length%4,o=4294967295;for(let i=0;i<
s;i+=4)o^=a[i]|a[i+1]<<8|a[i+2]<<16|a[i+3]<<24,o=n[o&255]^r[o>>>8&255]^t[o>>>16&255]^e[o>>>24];for(let i=s;i<a.length;i+=
1)o=o>>>8^e[(o^a[i])&255];return~o>>>0}async function Na(a,e){let t=[],r=0,n=a?.getReader();try{for(;;){let{done:o=!0,value:i}=await n?.
read()??{};if(o||!i)break;t.push(i),r+=i.length,e(r)}}catch(o){throw n?.cancel().catch(()=>{}),o}let s=new Uint8Array(r);
return t.reduce((o,i)=>(s.set(i,o),o+i.length),0),s}var Gr=class a{kind="bytes_to_bytes";static fromConfig(){return new a}encode(){
throw new Error("nothing is written")}decode(e){let t=e.byteLength-Hr;if(t<0)throw new Error("the checksum is missing");
let{buffer:r,byteOffset:n}=e,s=new DataView(r,n+t,Hr).getUint32(0,!0),o=new Uint8Array(r,n,t);if(s!==Uc(o))throw new Error(
"checksum mismatch");return o}computeEncodedSize(e){return e+Hr}},zr=class a{kind="bytes_to_bytes";most;constructor(e){this.
most=e}static fromConfig(e,{shape:t}){return new a(Math.min(t.reduce((r,n)=>r*n,Nc),Ic))}encode(){throw new Error("nothi\
ng is written")}async decode(e){let t=new Blob([e]).stream();return Na(t.pipeThrough(new DecompressionStream("gzip")),r=>{
if(r>this.most)throw new Error(`a chunk unpacks to more than ${this.most} bytes`)})}};qe.set("gzip",()=>Promise.resolve(
zr));qe.set("crc32c",()=>Promise.resolve(Gr));function Vc(a,e){return new Promise((t,r)=>{let n=()=>{clearTimeout(s),r(e.
reason)},s=setTimeout(()=>{e.removeEventListener("abort",n),t()},a);e.addEventListener("abort",n,{once:!0})})}async function Dc(a,e){
let t=new AbortController,r=()=>t.abort();e.addEventListener("abort",r,{once:!0});let n=setTimeout(r,ka);try{e.throwIfAborted();
let{status:s,body:o}=await fetch(a,{signal:t.signal}),i=await Na(s===Fa?o:null,()=>{clearTimeout(n),n=setTimeout(r,ka)});
return[s,i]}finally{t.abort(),clearTimeout(n),e.removeEventListener("abort",r)}}async function Oa(a,e){for(let t=0;;t+=1){
let r="no server answers";try{let[n,s]=await Dc(a,e);if(n===Fa)return s;if(Lc.includes(n))return;if(r=`the server answer\
s ${n}`,n<Oc&&n!==kc)throw new $("broken",r)}catch(n){if(e.throwIfAborted(),n instanceof $)throw n}if(t===La.length)throw new $(
"unreachable",r);await Vc(La[t],e)}}var or=class{url;described;shards=new Map;constructor(e,t){this.url=e,this.described=
t}get=async(e,t)=>e.endsWith("/zarr.json")?this.description(e):this.object(e,t?.signal);getRange=async(e,t,r)=>{let n=this.
shards.get(e)??this.object(e,r?.signal);this.shards.set(e,n);let s=await n;return"suffixLength"in t?s?.subarray(-t.suffixLength):
s?.subarray(t.offset,t.offset+t.length)};async object(e,t=new AbortController().signal){let r=await Oa(this.url+e,t);if(!r)
throw new $("missing",`${e} is missing`);return r}description(e){let t=this.described.get(e);if(t)return t;let r=Oa(this.
url+e,new AbortController().signal);return this.described.set(e,r),r.catch(()=>this.described.delete(e)),r}};function Ia(a){
if(a instanceof $)return a;let e=a instanceof q&&!a.found?"missing":"broken";return new $(e,a instanceof Error?a.message:
String(a))}var ir=class{url;described=new Map;constructor(e){this.url=e.replace(/\/+$/,"")}async attributes(){let e=new or(
this.url,this.described);return(await ee.v3(sr(e),{kind:"group"})).attrs}async array(e){let t=new or(this.url,this.described),
r=await ee.v3(sr(t).resolve(e),{kind:"array"});if(!r.is("number"))throw new $("broken",`${e} has no numbers`);return r}};var Bc=64,Hc=32,cr=4096,Gc=2**28,zc=["padded","unit","open","nearest","normal","rays"],Wc={missing:"it is not in the sto\
re, or the store is not public.",broken:"its data in the store are corrupt.",unreachable:"the store does not answer. The\
 server or the network may be down, or the server does not allow this page to read it (CORS)."},$c=["format","fingerprin\
t","parameter","lines"],ve=(a,e)=>Number.isInteger(a)&&Number(a)>0&&Number(a)<=e,j=(a,e)=>Array.isArray(a)&&a.every(Number.
isFinite)&&(e??a.length)===a.length,jc=(a,e)=>j(a,e)&&a.every(Number.isInteger);function Xc({nodes:a,longest:e=0,poles:t=[]}){
return Number.isFinite(e)&&t.length<=2&&t.every(({component:r,line:n,inward:s,near:o,plane:i})=>[0,1].includes(r)&&r===t[0].
component&&n===(s>0?0:a[1-r]-1)&&[1,-1].includes(s)&&ve(o,cr)&&j(i,6))}function Yc(a,{geometry:e,slices:t}){let{geometry:r,
slices:n}=a,{shape:s,rows:o,columns:i}=r,{trace:c}=n;if(!(j(s,2)&&s.every(h=>ve(h,cr)&&h>1)&&[o,i].every(({before:h,size:u},m)=>Number.
isInteger(h)&&ve(u,cr)&&h>=0&&h+s[m]<=u)&&Number.isInteger(r.levels)&&r.levels>=0&&2**r.levels<=Math.max(o.size,i.size)&&
r.triangles===e.triangles&&r.planar===e.planar&&Number.isFinite(r.extent)&&j(r.periodic.map(Number),2)&&j(r.center,3)&&j(
r.frame,9)&&ve(n.count,Bc)&&[2,4].includes(n.channels)&&j(n.lags)&&ve(n.lags.length,Hc)&&n.sides===t.sides&&j(n.extra)&&
n.extra.every(h=>Number.isInteger(h)&&h>=0&&h<n.count)&&j([n.unit,n.cell,n.critical])&&(!c||c.parts.every(h=>zc.includes(
h))&&j(c.nodes,2)&&c.nodes.every((h,u)=>ve(h,cr)&&c.drawn[u]+s[u]<=h)&&jc([...c.first,...c.drawn],4)&&c.drawn.every(h=>h>=
0)&&j(c.closed.map(Number),2)&&j([...c.offset,...c.middle,c.unit,c.pace,c.rest],12)&&Xc(c)&&(!c.timed||j([c.timed.unit,c.
timed.speed],2)))))throw new Error("the header of a tile does not match the page")}function Ua({geometry:a,slices:e}){let{
shape:t,planar:r}=a,{trace:n,count:s,channels:o,extra:i}=e,c=(p,...f)=>[...p,...f].reduce((d,b)=>d*b,1),l=[a.rows.size,a.
columns.size],h=n?.nodes??[],u={cells:[Uint8Array,[c(t.map(p=>p-1))]],normal:[Int16Array,[c(t,3)]],scalars:[Float32Array,
[c(t)]]};if(n){u.unit=[Uint16Array,[c(h)]],u.padded=[Float32Array,[c(h.map(f=>f+2),3)]],u.open=[Uint8Array,[c(h)]],u.nearest=
[Int16Array,[c(h,2)]];let p=n.poles??[];u.rays=[Float32Array,[c(p.slice(0,1).map(f=>h[f.component]),2,p.length)]],u.flow=
[Uint16Array,n.uncertain?[c(h,5)]:[c(h,3),c(h,4)]]}else u.position=[Float32Array,[c(t,3)]],u.slices=[Uint16Array,[c(l,s,
o)]],u.extra=[Uint16Array,[c(l,i.length)]];let m=n?["mesh",...n.parts]:["mesh","position",...r?[]:["normal"]];return{sizes:u,
needed:m}}function Wr(a,e,t){let{sizes:r}=Ua(e),n=e.geometry.shape.map(s=>Math.ceil((s-1)/t));for(let{name:s,data:o,shape:i}of a){
let c=r[s.split("/")[0]];if(!(c?o instanceof c[0]&&c[1].includes(o.length):s==="mesh"&&o instanceof Float32Array&&i.length===
3&&i[0]===n[0]&&i[1]===n[1]&&o.length===i[0]*i[1]*i[2]))throw new Error(`the part "${s}" of a tile has a wrong size`)}}function qc(a,{
geometry:e,slices:t},r){let[n,s]=e.shape,[o,{drawn:i,nodes:c}={drawn:[0,0],nodes:[0,0]}]=[a.shape[2],t.trace],l=new Float32Array(
n*s);for(let h=0;h<l.length;h+=1){let u=(Math.floor(h/s)+i[0])*c[1]+h%s+i[1];l[h]=r*Re[Number(a.data[o*(u+1)-1-Number(t.
trace?.uncertain??!1)])]}return{name:"",data:l,shape:[n,s],digest:`${a.digest} speed`}}function Ca(a){let e=Ia(a);return e.
fault==="other"||e.detail!==e.message?e:new $(e.fault,Wc[e.fault],e.message)}var lr=class{hasSteps=!0;atOnce=6;memory=18e7;header;told;url;store;headers=new Map;opening=null;constructor(e,t){
let r=e.store;if(!r)throw new Error("the page does not say where its store is");this.header=e,this.told=r,this.url=new URL(
r.url,t),this.store=new ir(this.url.href)}open(){return this.opening??=this.compare().catch(e=>{let t=Ca(e);throw t.fault===
"unreachable"&&(this.opening=null),t}),this.opening}async compare(){let{url:e}=this.told;if(!/^https?:/.test(this.url.protocol)){
let n=`This page reads its store from ${e} in the same folder, which browsers do not allow when the page is opened as a \
file: open it from a web server.`;throw new $("other",n)}let t=(await this.store.attributes()).flowtex;if($c.every(n=>t?.[n]===
this.told[n]))return;let r=`The store at ${e} does not match this page: it has another flow, other paths or another vers\
ion: export the page again.`;throw new $("other",r)}load=async(e,t,r,n)=>{let s=e??[this.told.depth,0,0],o=z(s);return this.
loaded(r,async i=>{let c=t.filter(d=>!n(`slices/${d}`)&&!n(`flow/${d}`)),l=e?n("header")&&!c.length?this.headers.get(o):
void 0:this.header,h=l===void 0?this.surface(s,i):{header:l,parts:[]},u=new Map(c.map(d=>[d,this.flow(s,d,i)])),m=[...u.
values()],p=async()=>{let{header:d,parts:b}=await h;if(e&&this.headers.set(o,d),!d)return b;let[g,...y]=await Promise.all(
[this.values(s,d,t,n,i,u),...m]);if(Wr(y.flat(),d,this.header.mesh.tileCells),!y.every(x=>x.length))throw new Error(`til\
e ${o} has no flow`);return[...b,...y.flat(),...g]},[f]=await Promise.all([p(),...m]);return e?f.map(d=>({...d,name:`til\
e/${o}/${d.name}`})):f})};async loaded(e,t){let r=new AbortController;e.addEventListener("abort",()=>r.abort(),{once:!0});
try{return await this.open(),e.throwIfAborted(),await t(r.signal)}catch(n){throw e.throwIfAborted(),Ca(n)}finally{r.abort()}}async file(e,t,r,n){
let s=await this.store.array(`${t[0]}/${e}`),o=async f=>{let{data:d}=await s.getChunk([...r,f],{signal:n});if(!(d instanceof
Uint8Array))throw new Error(`${s.path} is empty`);return d},i=await o(0),[c,l]=fr(i),h=c.reduce((f,{bytes:d})=>f+d,l);if(!ve(
h,Gc))throw new Error(`a file of ${s.path} has a wrong size`);let u=new Uint8Array(Math.ceil(h/i.length)*i.length);u.set(
i);for(let f=1;f*i.length<h;f+=1)u.set(await o(f),f*i.length);let m=new Map;for(let f of rn(u.buffer)){let[d,b]=pe(f.name)??
["",f.name];if(d&&d!==z(t))throw new Error(`in place of tile ${z(t)} is ${d}`);m.set(b,{...f,name:b})}if(new TextDecoder().
decode(m.get("of")?.data)!==this.told.fingerprint)throw new Error(`tile ${z(t)} belongs to another flow`);return m.delete(
"of"),m}async surface(e,t){let r=await this.file("surface",e,[e[1],e[2]],t),n=this.tileHeader(r.get("header"));if(r.delete(
"header"),n){let i=Ua(n).needed.filter(c=>!r.has(c));if(i.length)throw new Error(`a tile has no ${i.join(", ")}`);Wr([...r.
values()],n,this.header.mesh.tileCells)}let s=new TextEncoder().encode(JSON.stringify(n)),o={name:"header",data:s,shape:[
s.length],digest:`${this.told.fingerprint} ${z(e)} header`};return{header:n,parts:[o,...r.values()]}}tileHeader(e){let t=JSON.
parse(new TextDecoder().decode(e?.data));if(t===null)return null;let{steps:r,times:n,timeUnit:s,dates:o,pace:i}=this.header.
slices;return Yc(t,this.header),{...t,slices:{...t.slices,steps:r,times:n,timeUnit:s,dates:o,pace:i}}}async flow(e,t,r){
let n=this.told.steps[t];return[...(await this.file("flow",e,[n,e[1],e[2]],r)).values()].map(o=>{let[i,c]=o.name.split("\
/");if(Number(c)!==n)throw new Error(`in place of step ${n} is ${o.name}`);return{...o,name:`${i}/${t}`}})}async values(e,t,r,n,s,o){
let i=new Map;for(;;){let{name:c,steps:l,number:h}=this.header.scalars,m=(l>1?r:[0]).map(d=>h?`scalars/${d}/${h}`:`scala\
rs/${d}`),p=c===null?[]:m.filter(d=>!n(d)&&!i.has(d));if(!p.length)return[...i.values()];let f=await Promise.all(p.map(async d=>{
let b=l>1?Y(d):0;if(!h&&this.told.derivesSpeed&&t.slices.trace){let[v]=await(o.get(b)??this.flow(e,b,s));return{...qc(v,
t,this.header.speed.typical),name:d}}let g=l>1?this.told.steps[b]:0,x=(await this.file("values",e,[g,e[1],e[2],h],s)).get(
`scalars/${g}/${h}`);if(!x)throw new Error(`tile ${z(e)} has no values of step ${g}`);return{...x,name:d}}));Wr(f,t,this.
header.mesh.tileCells);for(let d of f)i.set(d.name,d)}}};var Kc=4096,Jc=4,Va=32,Zc=.25,Qc=1e4,Da=class{id;type="custom";renderingMode="2d";options;map=null;gl=null;programs=null;array=null;scene=null;pictures=[];look="";globe=!1;shownOpacity=1;close=null;asked=Promise.
resolve(null);own;colours={};constructor(e){this.options=e,this.own={...e.settings},this.id=e.id}onAdd(e,t){this.onRemove(),
this.map=e,this.gl=t;let r={context:t,counted:n=>n,free:()=>{}};this.programs=new Se(r),this.array=t.createVertexArray(),
this.open(t).catch(n=>this.failed(n.message,""))}onRemove(){let{gl:e}=this;for(let t of this.pictures)t.dispose(e);this.
close?.then(t=>t.dispose()),this.close=null,e?.deleteVertexArray(this.array),this.programs?.dispose(),this.map=this.gl=this.
scene=null,[this.pictures,this.look]=[[],""]}async open(e){let{scene:t,opacity:r}=this.options,n=new URL(typeof t=="stri\
ng"?t:"",location.href).href,{headers:s,parts:o}=typeof t=="string"?await el(n):t;if(this.gl!==e)return;let i=tl(s[0]),c=new zt(
i,o.flatMap(([f,d,b])=>f?[]:[[d,b]]),new Map,new Map),l=i.store?new lr(i,n):c,h={header:i,settings:{...i.settings,...i.own,
...this.own},player:new ht};this.shownOpacity=r??s[0].opacity;let u=async(f,d)=>{let b=!0,g=new Ct(f,{...h,source:l,isComing:()=>b});
d(g);for(let y of c.parts){let x=await c.kept(y);if(g.lifetime.isOver)break;g.setPart(x)}return b=!1,Object.keys(this.colours).
length&&g.chooseColours(this.colours),g},m=()=>{let f=null;return u(this.hostOf(()=>f),d=>this.pictures.push(f=new Gt(e,
d)))},p=await m();this.gl===e&&(this.scene={...h,add:m,make:u,mercator:new Bt(i.earth,p.parts.get("lonlat"),i.ends)},p.requests.
open(),this.options.onOpen?.(),this.map?.triggerRepaint())}hostOf=e=>({isHeld:()=>this.map?.isMoving()??!1,painted:t=>{e()?.
painted(t),this.map?.triggerRepaint()},advanced:()=>this.options.onTime?.(this.time),failed:(t,r)=>this.failed(t,r)});get time(){
let{varies:e=!1,time:t=0,clock:r=0}=this.scene?.player??{};return e?t:r}set time(e){let{player:t}=this.scene??{};t?.varies?
t.seek(e):t&&(t.clock=e),this.change()}get times(){return this.scene?.header.slices.times??[]}get bounds(){let{mercator:e}=this.
scene??{};if(!e)return null;let{box:t}=e;return[e.lngLatOf(t.slice(0,2)),e.lngLatOf(t.slice(2))]}get opacity(){return this.
shownOpacity}set opacity(e){this.shownOpacity=e,this.map?.triggerRepaint()}play(){let{player:e,settings:t}=this.scene??{};
!e||!t||(!e.varies&&t.motion==="off"&&(t.motion="speed"),e.start(),this.change())}pause(){this.scene&&(this.scene.player.
playing=!1),this.change()}set(e){Object.assign(this.own,e),Object.assign(this.scene?.settings??{},e),this.change()}setColours(e){
Object.assign(this.colours,e);for(let{view:t}of this.pictures)t.chooseColours(e)}change(){for(let{view:e}of this.pictures)
e.change()}async pointAt(e){let{mercator:t,header:r}=this.scene??{};if(!t||!r)return null;let n=[...t.positionOf(be(e)),
r.geometry.center[2]],s=this.pictures.filter(({isUsed:c})=>c).map(({view:c})=>c);await Ha(()=>s.every(({painter:c})=>c.canPick&&
c.shown));let o=s.map(c=>this.pointIn(c,n)).find(Boolean)??null;if(o&&!r.pyramid)return o;this.asked=this.asked.then(()=>this.
pointClose(n)).catch(()=>null);let i=await this.asked;return i&&{...i,path:o?.path??i.path}}pointIn(e,t){let{camera:r,parts:n,
settings:s}=e,{mercator:o}=this.scene??{},i=r?.project(t)??[2,2],c=Math.max(...i.map(Math.abs))>1?null:e.find(i[0],i[1]),
l=e.painter.shown;if(!o||!r||!c||!l)return null;let h=c.point.position,u={scene:c.layer.scene,moment:l,place:c.place,position:h},
[m,p]=ws(u,n.get("lonlat"))??[NaN,NaN],{path:f}=bs(u,s,r,e.rows);return{eastward:m,northward:p,values:c.point.values,path:f.
map(d=>o.lngLatOf(d))}}async pointClose(e){let{scene:t}=this;if(!t)return null;let r={...this.hostOf(()=>null),painted:()=>{},
advanced:()=>{}},n=await(this.close??=t.make(r,p=>p.requests.open())),{box:s}=t.mercator,{pyramid:o,geometry:i}=t.header,
c=Zc*(s[2]-s[0])/(o?.shapes[0]??i.shape)[1],[l,h,u]=e,m={up:[0,1,0],view_angle:30,position:[l,h,u+c],focal_point:e,parallel:!0,
parallel_scale:c};return n.isVisible=!0,n.look(m,Va,Va,1),await Ha(()=>!n.isNew&&n.painter.canPick&&!n.tiles?.pending&&!n.
tiles?.missing.length),n.isVisible=!1,this.pointIn(n,e)}failed(e,t){this.map?.fire("error",{error:new Error([e,t].filter(
Boolean).join(" "))})}render(e,t){let{map:r,scene:n,programs:s,array:o,opacity:i}=this;if(!r||!n||!s)return;let c=t.defaultProjectionData.
projectionTransition>0;this.follow(r,n,c);let[l,h]=[r.getZoom(),r.getCenter()],u=this.pictures.filter(({isUsed:d})=>d),{
shaderData:m,getProjectionData:p}=t,f={gl:e,programs:s,array:o,shaderData:m,getProjectionData:p,zoom:l,center:h,globe:c,
opacity:i};for(let d of u){let b=d.draw({...f,mercator:n.mercator,isRepeated:u.length===1});typeof b=="string"&&b?this.failed(
"The flow cannot be drawn on the map.",b):b!==!0&&r.triggerRepaint()}}follow(e,{mercator:t,header:r,add:n},s){let{what:o,
ratio:i,text:c}=Ba(e,s);if(c===this.look)return;let l=t.look(o,r.geometry.center[2]);l.length>this.pictures.length&&n(),
[0,1].forEach(h=>{let{width:u=1,height:m=1}=l[h]??{},p=Math.sqrt(Jc*o.width*o.height/(u*m));this.pictures[h]?.follow(l[h],
Math.min(i,i*p,Kc/Math.max(u,m)))}),this.look=c,this.globe=s}get isComplete(){let{map:e,pictures:t}=this;return!e||!this.
scene||!t.every(r=>r.isComplete)?!1:this.look===Ba(e,this.globe).text}};function Ba(a,e){let{clientWidth:t,clientHeight:r}=a.
getCanvas(),n={center:a.unproject([t/2,r/2]),width:t,height:r,zoom:a.getZoom(),bearing:a.getBearing(),pitch:a.getPitch(),
fov:a.getVerticalFieldOfView(),globe:e},s=a.getPixelRatio();return{what:n,ratio:s,text:JSON.stringify([n,s])}}async function Ha(a){
let e=performance.now()+Qc;for(;!a()&&performance.now()<e;)await new Promise(requestAnimationFrame)}async function el(a){
let e=await fetch(a);if(!e.ok)throw new Error(`the scene ${a} cannot be read: the server answers ${e.status}`);return await e.
json()}function tl(a){let{earth:e}=a,t={land:null,coastlines:!1,graticule:!1};return{...a,ends:rl(a),background:[0,0,0],
opacity:1,earth:e&&{...e,...t}}}function rl({earth:a,geometry:e,slices:t}){let{map:r}=a??{};if(!a||!r||!e.periodic[1])return null;
let n=.5*(r[0]+r[2]),s=.5*(t.trace?.offset[3]??2*Math.PI*a.radius);return[n-s,n+s]}export{Da as FlowtexLayer};
